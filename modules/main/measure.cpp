#include "modules/main/measure.h"

#include "modules/core/progress.h"
#include "modules/mesh_tools/topology.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <thread>

namespace gnomon {

namespace {

using Json = nlohmann::ordered_json;

double compute_percentile(std::vector<double> p_values, double p_share) {
	if (p_values.empty()) {
		return 0;
	}
	std::sort(p_values.begin(), p_values.end());
	const double position = p_share * static_cast<double>(p_values.size() - 1);
	const size_t below = static_cast<size_t>(position);
	const size_t above = std::min(below + 1, p_values.size() - 1);
	return p_values[below] + (p_values[above] - p_values[below]) * (position - double(below));
}

struct PassSamples {
	std::vector<double> gpu_ms;
	std::vector<double> wall_ms;
};

/// Frames' samples per pass, in the order of the first frame, and their sums per frame.
struct Samples {
	std::vector<std::string> names;
	std::map<std::string, PassSamples> passes;
	PassSamples totals;

	void add(const std::vector<PassTiming> &p_timings, const std::string &p_prefix) {
		PassTiming sum;
		for (const PassTiming &timing : p_timings) {
			if (timing.name.rfind(p_prefix, 0) != 0) {
				continue;
			}
			const std::string name = timing.name.substr(p_prefix.size());
			if (passes.find(name) == passes.end()) {
				names.push_back(name);
			}
			passes[name].gpu_ms.push_back(timing.gpu_ms);
			passes[name].wall_ms.push_back(timing.wall_ms);
			sum.gpu_ms += timing.gpu_ms;
			sum.wall_ms += timing.wall_ms;
		}
		totals.gpu_ms.push_back(sum.gpu_ms);
		totals.wall_ms.push_back(sum.wall_ms);
	}
};

Json describe_totals(const PassSamples &p_samples) {
	return { { "gpu_ms", compute_percentile(p_samples.gpu_ms, 0.5) },
		{ "gpu_ms_p90", compute_percentile(p_samples.gpu_ms, 0.9) },
		{ "wall_ms", compute_percentile(p_samples.wall_ms, 0.5) },
		{ "wall_ms_p90", compute_percentile(p_samples.wall_ms, 0.9) } };
}

} // namespace

std::string measure_mask_time(
		Renderer &r_renderer, RenderRequest p_request, uint32_t p_warm_up_count, uint32_t p_count) {
	p_request.wants_mask = false;
	p_request.may_keep = false;
	p_request.mode = RenderGraph::Mode::ONE_BY_ONE;
	Progress progress("Measuring");
	Samples moving;
	PassSamples frames;
	for (uint32_t index = 0; index < p_warm_up_count + p_count; ++index) {
		progress.update(double(index) / (p_warm_up_count + p_count));
		const RenderResult result = r_renderer.render(p_request);
		if (index >= p_warm_up_count) {
			moving.add(result.timings, p_request.mask_light + ": ");
		}
	}
	p_request.mode = RenderGraph::Mode::WAIT;
	for (uint32_t index = 0; index < p_count; ++index) {
		const RenderResult result = r_renderer.render(p_request);
		frames.gpu_ms.push_back(result.gpu_ms);
		frames.wall_ms.push_back(result.wall_ms);
	}

	Json passes = Json::array();
	for (const std::string &name : moving.names) {
		passes.push_back({ { "name", name },
				{ "gpu_ms", compute_percentile(moving.passes[name].gpu_ms, 0.5) },
				{ "wall_ms", compute_percentile(moving.passes[name].wall_ms, 0.5) } });
	}
	uint64_t triangle_count = 0;
	uint64_t edge_count = 0;
	for (const InstanceSnapshot &instance : p_request.scene->instances) {
		if (instance.casts_shadow) {
			triangle_count += instance.mesh->get_triangle_count();
			edge_count += get_topology(instance.mesh)->edges.size();
		}
	}
	const DeviceInfo &info = r_renderer.get_device().get_info();
	const Json json = { { "device", info.name }, { "driver", info.driver },
		{ "threads", std::thread::hardware_concurrency() }, { "frames", p_count },
		{ "triangles", triangle_count }, { "edges", edge_count }, { "passes", passes },
		{ "total", describe_totals(moving.totals) }, { "frame", describe_totals(frames) },
		{ "bytes", r_renderer.get_device().get_memory_use().used_bytes } };
	return json.dump(2) + "\n";
}

} // namespace gnomon
