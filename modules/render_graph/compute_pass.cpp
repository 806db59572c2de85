#include "modules/render_graph/compute_pass.h"

#include <algorithm>

namespace gnomon {

namespace {

/// How the steps of one pass use a resource.
struct StepResource {
	RGTexture texture;
	RGBuffer buffer;
	Access declared = Access::NONE; // between passes: that which the graph knows
	PassBuilder::Content content = PassBuilder::Content::FRESH;
	Access last = Access::NONE; // NONE: no step has used it
};

StepResource &find_step_resource(
		std::vector<StepResource> &r_resources, RGTexture p_texture, RGBuffer p_buffer) {
	const auto found = std::find_if(
			r_resources.begin(), r_resources.end(), [&](const StepResource &p_resource) {
				return p_resource.texture.index == p_texture.index &&
						p_resource.buffer.index == p_buffer.index;
			});
	if (found != r_resources.end()) {
		return *found;
	}
	r_resources.push_back({ p_texture, p_buffer });
	return r_resources.back();
}

/// Collects the resources of all steps. One that some step writes is declared with that access.
std::vector<StepResource> collect_step_resources(const std::vector<ComputeStep> &p_steps) {
	std::vector<StepResource> resources;
	const auto add = [&](RGTexture p_texture, RGBuffer p_buffer, Access p_access,
							 PassBuilder::Content p_content) {
		StepResource &resource = find_step_resource(resources, p_texture, p_buffer);
		if (resource.declared == Access::NONE) {
			resource.content = is_write(p_access) ? p_content : PassBuilder::Content::UPDATE;
		}
		if (resource.declared == Access::NONE || is_write(p_access)) {
			resource.declared = p_access;
		}
	};
	for (const ComputeStep &step : p_steps) {
		for (const PassBinding &binding : step.bindings) {
			add(binding.texture, binding.buffer, binding.access, binding.content);
		}
		if (step.arguments) {
			add({}, step.arguments, Access::INDIRECT_READ, PassBuilder::Content::UPDATE);
		}
	}
	return resources;
}

/// Adds the barrier before another use of a resource, unless both uses only read it in one way.
void push_step_barrier(PassContext &r_context, StepResource &r_resource, Access p_access,
		std::vector<Barrier> &r_barriers) {
	const Access before = r_resource.last == Access::NONE ? r_resource.declared : r_resource.last;
	const bool is_hazard = r_resource.last != Access::NONE && is_write(before);
	if (is_hazard || before != p_access) {
		Barrier barrier = { .before = before, .after = p_access };
		if (r_resource.texture) {
			barrier.texture = r_context.get(r_resource.texture);
		} else {
			barrier.buffer = r_context.get(r_resource.buffer);
		}
		r_barriers.push_back(barrier);
	}
	r_resource.last = p_access;
}

void record_step(
		PassContext &r_context, const ComputeStep &p_step, std::vector<StepResource> &r_resources) {
	std::vector<Barrier> barriers;
	for (const PassBinding &binding : p_step.bindings) {
		push_step_barrier(r_context,
				find_step_resource(r_resources, binding.texture, binding.buffer), binding.access,
				barriers);
	}
	if (p_step.arguments) {
		push_step_barrier(r_context, find_step_resource(r_resources, {}, p_step.arguments),
				Access::INDIRECT_READ, barriers);
	}
	if (!barriers.empty()) {
		r_context.commands.barriers(barriers);
	}
	bind_compute(r_context, p_step.pipeline, p_step.bindings, p_step.push);
	if (p_step.arguments) {
		r_context.commands.dispatch_indirect(
				r_context.get(p_step.arguments), p_step.arguments_offset_bytes);
	} else {
		r_context.commands.dispatch_items(p_step.item_count);
	}
}

} // namespace

void declare_bindings(PassBuilder &r_pass, std::span<const PassBinding> p_bindings) {
	for (const PassBinding &binding : p_bindings) {
		const RGResource resource =
				binding.texture ? RGResource(binding.texture) : RGResource(binding.buffer);
		if (is_write(binding.access)) {
			r_pass.writes(resource, binding.access, binding.content);
		} else {
			r_pass.reads(resource, binding.access);
		}
	}
}

void bind_compute(PassContext &r_context, PipelineRID p_pipeline,
		std::span<const PassBinding> p_bindings, std::span<const uint8_t> p_push) {
	std::vector<Binding> resources;
	for (const PassBinding &binding : p_bindings) {
		if (binding.texture) {
			resources.emplace_back(
					binding.binding, r_context.get(binding.texture), binding.sampler);
			resources.back().layer = binding.layer;
		} else {
			resources.emplace_back(binding.binding, r_context.get(binding.buffer));
		}
	}
	r_context.commands.bind_pipeline(p_pipeline);
	r_context.commands.bind_resources(resources);
	if (!p_push.empty()) {
		r_context.commands.push_constants(p_push);
	}
}

void add_compute_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, glm::uvec3 p_item_count,
		std::span<const uint8_t> p_push) {
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, p_bindings);
	std::vector<uint8_t> push(p_push.begin(), p_push.end());
	pass.execute([p_pipeline, bindings = std::move(p_bindings), push = std::move(push),
						 p_item_count](PassContext &p_context) {
		bind_compute(p_context, p_pipeline, bindings, push);
		p_context.commands.dispatch_items(p_item_count);
	});
}

void add_compute_steps(
		RenderGraph &r_graph, const std::string &p_name, std::vector<ComputeStep> p_steps) {
	if (p_steps.empty()) {
		return;
	}
	std::vector<StepResource> resources = collect_step_resources(p_steps);
	PassBuilder pass = r_graph.add_pass(p_name);
	for (const StepResource &resource : resources) {
		const RGResource handle =
				resource.texture ? RGResource(resource.texture) : RGResource(resource.buffer);
		if (is_write(resource.declared)) {
			pass.writes(handle, resource.declared, resource.content);
		} else {
			pass.reads(handle, resource.declared);
		}
	}
	pass.execute(
			[steps = std::move(p_steps), resources = std::move(resources)](PassContext &p_context) {
				std::vector<StepResource> used = resources;
				for (const ComputeStep &step : steps) {
					record_step(p_context, step, used);
				}
				std::vector<Barrier> barriers; // back to the access that the graph knows
				for (StepResource &resource : used) {
					if (resource.last != resource.declared) {
						push_step_barrier(p_context, resource, resource.declared, barriers);
					}
				}
				if (!barriers.empty()) {
					p_context.commands.barriers(barriers);
				}
			});
}

} // namespace gnomon
