#include "modules/core/error.h"
#include "modules/render_graph/render_graph_types.h"

#include <chrono>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

double compute_milliseconds_since(Clock::time_point p_start) {
	return std::chrono::duration<double, std::milli>(Clock::now() - p_start).count();
}

} // namespace

void RenderGraph::collect_barriers(uint32_t p_pass_index, std::vector<Barrier> &r_barriers) {
	for (const Use &use : passes[p_pass_index].uses) {
		Resource &resource = resources[use.resource];
		if (use.access == Access::HOST_READ || use.access == Access::HOST_WRITE) {
			// This use needs no barrier: the device makes the GPU's writes visible to the host at
			// the end of each submission, and a submission sees all earlier writes of the host.
			resource.last_access = use.access;
			continue;
		}
		Barrier barrier = { resource.buffer, resource.texture, resource.last_access, use.access };
		if (resource.first_pass == p_pass_index) {
			if (!resource.is_texture && resource.earlier_users.empty()) {
				resource.last_access = use.access;
				continue; // the device orders submissions, see submit_commands()
			}
			// Imported textures are in SHADER_READ_COMPUTE between frames, see transition_imported.
			barrier.before = resource.is_imported && resource.has_content && use.needs_content
					? Access::SHADER_READ_COMPUTE
					: Access::NONE;
			barrier.earlier_users = resource.earlier_users;
		}
		// Each change of access gets a barrier. The barriers form a chain, so that the last one
		// waits for all.
		const bool is_hazard = is_write(barrier.before) || is_write(barrier.after);
		if (is_hazard || barrier.before != barrier.after) {
			r_barriers.push_back(barrier);
		}
		resource.last_access = use.access;
	}
}

void RenderGraph::transition_imported(std::vector<Barrier> &r_barriers) {
	for (Resource &resource : resources) {
		const bool is_unused = resource.first_pass == ~0u;
		if (!resource.is_imported || !resource.is_texture || is_unused || resource.acquire) {
			continue;
		}
		const Access rest = Access::SHADER_READ_COMPUTE;
		if (resource.last_access != rest) {
			r_barriers.push_back({ /*buffer=*/{}, resource.texture, resource.last_access, rest });
			resource.last_access = rest;
		}
	}
}

RenderGraph::Resource *RenderGraph::find_window_image(const Pass &p_pass) {
	for (const Use &use : p_pass.uses) {
		if (resources[use.resource].acquire) {
			return &resources[use.resource];
		}
	}
	return nullptr;
}

void RenderGraph::record_pass(Pass &p_pass, CommandList &p_commands) {
	PassContext context(p_commands, *this);
	const bool is_raster = !p_pass.colors.empty() || p_pass.depth;
	if (is_raster) {
		std::vector<ColorTarget> colors;
		for (const auto &[texture, target] : p_pass.colors) {
			colors.push_back(target);
			colors.back().texture = context.get(texture);
		}
		if (p_pass.depth) {
			p_pass.depth->second.texture = context.get(p_pass.depth->first);
		}
		p_commands.begin_rendering(colors, p_pass.depth ? &p_pass.depth->second : nullptr);
	} else if (p_pass.size_without_targets_px) {
		p_commands.begin_rendering_without_targets(*p_pass.size_without_targets_px);
	}
	if (p_pass.record) {
		p_pass.record(context);
	}
	if (is_raster || p_pass.size_without_targets_px) {
		p_commands.end_rendering();
	}
}

void RenderGraph::collect_spans() {
	for (const GpuSpan &span : device.get_gpu_spans()) {
		timings.push_back({ span.name, span.gpu_ms, /*wall_ms=*/0 });
	}
}

void RenderGraph::execute(Mode p_mode) {
	GNOMON_ASSERT(!is_executed, "a graph runs once");
	is_executed = true;
	cull();
	compute_lifetimes();
	allocate();
	try {
		run_passes(p_mode);
	} catch (...) {
		device.abandon_commands(); // the next frame must not contain these commands
		throw;
	}
}

void RenderGraph::run_passes(Mode p_mode) {
	const Clock::time_point start = Clock::now();
	Clock::time_point pass_start = start;
	CommandList *commands = nullptr;
	std::vector<Barrier> barriers;
	for (uint32_t index = 0; index < passes.size(); ++index) {
		Pass &pass = passes[index];
		if (pass.is_culled) {
			continue;
		}
		if (pass.run_on_host) {
			if (commands) {
				device.submit_commands(RenderingDevice::SubmitMode::WAIT);
				collect_spans();
				commands = nullptr;
			}
			barriers.clear();
			collect_barriers(index, barriers);
			GNOMON_ASSERT(barriers.empty(), "host pass ", pass.name,
					" has a use other than HOST_READ and HOST_WRITE");
			const Clock::time_point host_start = Clock::now();
			HostContext context(*this);
			pass.run_on_host(context);
			timings.push_back({ pass.name, /*gpu_ms=*/0, compute_milliseconds_since(host_start),
					/*is_on_host=*/true });
			continue;
		}
		if (!commands) {
			pass_start = Clock::now();
			commands = &device.begin_commands();
		}
		Resource *window_image = find_window_image(pass);
		if (window_image) {
			const std::optional<TextureRID> image = window_image->acquire();
			if (!image) {
				continue; // the window has no image now, for example because it is minimised
			}
			window_image->texture = *image;
		}
		commands->begin_span(pass.name, pass.needs_time);
		barriers.clear();
		collect_barriers(index, barriers);
		if (!barriers.empty()) {
			commands->barriers(barriers);
		}
		record_pass(pass, *commands);
		if (window_image) {
			const Barrier barrier = { .texture = window_image->texture,
				.before = window_image->last_access,
				.after = Access::PRESENT };
			commands->barriers({ &barrier, 1 });
		}
		commands->end_span();
		if (p_mode == Mode::ONE_BY_ONE) {
			device.submit_commands(RenderingDevice::SubmitMode::WAIT);
			collect_spans();
			timings.back().wall_ms = compute_milliseconds_since(pass_start);
			commands = nullptr;
		}
	}
	barriers.clear();
	transition_imported(barriers);
	if (!barriers.empty() && !commands) {
		commands = &device.begin_commands();
	}
	if (commands) {
		if (!barriers.empty()) {
			commands->barriers(barriers);
		}
		const bool waits = p_mode != Mode::QUEUE;
		device.submit_commands(
				waits ? RenderingDevice::SubmitMode::WAIT : RenderingDevice::SubmitMode::QUEUE);
		collect_spans();
	}
	wall_ms = compute_milliseconds_since(start);
}

} // namespace gnomon
