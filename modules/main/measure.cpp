#include "modules/main/measure.h"

#include "modules/core/operating_system.h"
#include "modules/core/progress.h"
#include "modules/mesh_tools/caster_counts.h"
#include "modules/shadows/mesh_store.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <set>
#include <thread>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;

const char *const LIGHTING_PASS = "lighting"; // not counted, since it is not part of the shadow

/// Returns the costs of the shadow passes of the request's mask_light, or of all lights if that is
/// empty.
std::vector<PassCost> select_passes(const RenderResult &p_result, const RenderRequest &p_request) {
	std::vector<PassCost> passes;
	bool has_deform = false;
	for (const LightSnapshot &light : p_request.scene->lights) {
		if (!p_request.mask_light.empty() && light.name != p_request.mask_light) {
			continue;
		}
		for (const PassTiming &timing : p_result.find_light_passes(light.name)) {
			// The lights share one deform pass.
			const bool is_deform = timing.name == DEFORM_PASS_NAME;
			if (timing.name == LIGHTING_PASS || (is_deform && has_deform)) {
				continue;
			}
			has_deform = has_deform || is_deform;
			// With all lights, the light's name distinguishes their passes.
			const std::string name = p_request.mask_light.empty() && !is_deform
					? light.name + ": " + timing.name
					: timing.name;
			passes.push_back({ name, timing.gpu_ms, timing.wall_ms, timing.is_on_host });
		}
	}
	return passes;
}

} // namespace

MaskTiming measure_mask_timing(Renderer &r_renderer, RenderRequest p_request,
		const MeasureLimits &p_limits, const std::function<void(double)> &p_progress) {
	p_request.wants_mask = false;
	p_request.wants_surfaces = false;
	p_request.mode = RenderGraph::Mode::ONE_BY_ONE;
	TimingSamples samples;
	for (uint32_t index = 0; index < p_limits.warm_up_count; ++index) {
		r_renderer.render(p_request);
	}
	const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
	while (samples.get_frame_count() < p_limits.frame_count) {
		if (p_progress) {
			p_progress(double(samples.get_frame_count()) / p_limits.frame_count);
		}
		samples.add_frame(select_passes(r_renderer.render(p_request), p_request));
		const double seconds =
				std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
		const bool can_stop = seconds >= p_limits.seconds ||
				(p_limits.median_error > 0 &&
						samples.compute_median_error() <= p_limits.median_error);
		if (can_stop && samples.get_frame_count() >= p_limits.min_frame_count) {
			break;
		}
	}
	return samples.compute();
}

std::string measure_time(Renderer &r_renderer, RenderRequest p_request, uint32_t p_warm_up_count,
		uint32_t p_count, const RunPart::SnapshotBuilder &p_build_snapshot) {
	Progress progress("Measuring");
	const MaskTiming timing =
			measure_mask_timing(r_renderer, p_request, { p_warm_up_count, p_count, p_count },
					[&](double p_fraction) { progress.update(p_fraction * 0.5); });
	p_request.wants_mask = false;
	p_request.wants_surfaces = false;
	p_request.mode = RenderGraph::Mode::WAIT;
	std::vector<double> gpu_ms;
	std::vector<double> wall_ms;
	std::vector<double> call_ms; // with p_build_snapshot and all CPU work of render()
	double host_ms = 0;			 // sum of the CPU times of that
	RenderResult result;
	for (uint32_t index = 0; index < p_count; ++index) {
		progress.update(0.5 + 0.5 * double(index) / p_count);
		const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
		const double host_start_ms = read_thread_time_ms();
		if (p_build_snapshot) {
			p_request.scene = p_build_snapshot();
		}
		result = r_renderer.render(p_request);
		host_ms += read_thread_time_ms() - host_start_ms;
		call_ms.push_back(
				std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
						.count());
		gpu_ms.push_back(result.gpu_ms);
		wall_ms.push_back(result.wall_ms);
	}
	const CasterCounts casters =
			count_casters(*p_request.scene, p_request.scene->find_light(p_request.mask_light));
	const DeviceInfo &info = r_renderer.get_device().get_info();
	Json counters = Json::object();
	for (const WorkCounter &counter : result.counters) {
		counters[counter.name] = counter.value;
	}
	const Json json = { { "device", info.name }, { "driver", info.driver },
		{ "threads", std::thread::hardware_concurrency() }, { "frames", p_count },
		{ "triangles", casters.triangle_count }, { "edges", casters.edge_count },
		{ "passes", to_json(timing.passes) }, { "total", to_json(timing.total) },
		{ "frame", to_json(compute_frame_cost(gpu_ms, wall_ms)) },
		{ "call_ms", compute_percentile(call_ms, 0.5) }, { "host_ms", host_ms / p_count },
		{ "pass_count", result.timings.size() }, { "counters", counters },
		{ "draws", result.commands.draws }, { "dispatches", result.commands.dispatches },
		{ "bytes", r_renderer.get_device().get_memory_use().used_bytes } };
	return json.dump(2) + "\n";
}

} // namespace gnomon
