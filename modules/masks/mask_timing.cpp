#include "modules/masks/mask_timing.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace gnomon {

using Json = nlohmann::ordered_json;

double compute_percentile(std::vector<double> p_values, double p_fraction) {
	if (p_values.empty()) {
		return 0;
	}
	std::sort(p_values.begin(), p_values.end());
	const double position = p_fraction * static_cast<double>(p_values.size() - 1);
	const size_t below = static_cast<size_t>(position);
	const size_t above = std::min(below + 1, p_values.size() - 1);
	return p_values[below] + (p_values[above] - p_values[below]) * (position - double(below));
}

void TimingSamples::add_frame(const std::vector<PassCost> &p_passes) {
	PassCost sum;
	double cost_ms = 0;
	for (const PassCost &pass : p_passes) {
		auto found = std::ranges::find(passes, pass.name, &Values::name);
		if (found == passes.end()) {
			found = passes.insert(found, { pass.name });
		}
		Values &values = *found;
		values.gpu_ms.push_back(pass.gpu_ms);
		values.wall_ms.push_back(pass.wall_ms);
		values.is_on_host = pass.is_on_host;
		sum.gpu_ms += pass.gpu_ms;
		sum.wall_ms += pass.wall_ms;
		cost_ms += pass.is_on_host ? pass.wall_ms : pass.gpu_ms;
	}
	totals.gpu_ms.push_back(sum.gpu_ms);
	totals.wall_ms.push_back(sum.wall_ms);
	costs_ms.push_back(cost_ms);
}

MaskTiming TimingSamples::compute() const {
	MaskTiming timing;
	timing.frame_count = get_frame_count();
	for (const Values &values : passes) {
		timing.passes.push_back({ values.name, compute_frame_cost(values.gpu_ms, values.wall_ms),
				values.is_on_host });
	}
	timing.total = compute_frame_cost(totals.gpu_ms, totals.wall_ms);
	timing.cost_ms = compute_percentile(costs_ms, 0.5);
	return timing;
}

double TimingSamples::compute_median_error() const {
	const double median_ms = compute_percentile(costs_ms, 0.5);
	if (costs_ms.size() < 2 || median_ms <= 0) {
		return 1;
	}
	std::vector<double> distances_ms;
	for (const double cost_ms : costs_ms) {
		distances_ms.push_back(std::abs(cost_ms - median_ms));
	}
	// For a normal distribution, 1.4826 times the median absolute deviation is the standard
	// deviation, and the standard error of the median is 1.2533 times that of the mean.
	const double count = double(costs_ms.size());
	// count / (count - 0.8): the median absolute deviation of few values is too small (Croux,
	// Rousseeuw 1992).
	const double deviation_ms =
			1.4826 * compute_percentile(distances_ms, 0.5) * count / (count - 0.8);
	return 1.2533 * deviation_ms / std::sqrt(count) / median_ms;
}

FrameCost compute_frame_cost(
		const std::vector<double> &p_gpu_ms, const std::vector<double> &p_wall_ms) {
	return { compute_percentile(p_gpu_ms, 0.5), compute_percentile(p_gpu_ms, 0.9),
		compute_percentile(p_wall_ms, 0.5), compute_percentile(p_wall_ms, 0.9) };
}

Json to_json(const FrameCost &p_cost) {
	return { { "gpu_ms", p_cost.gpu_ms }, { "gpu_ms_p90", p_cost.gpu_ms_p90 },
		{ "wall_ms", p_cost.wall_ms }, { "wall_ms_p90", p_cost.wall_ms_p90 } };
}

Json to_json(const std::vector<PassMedians> &p_passes) {
	Json json = Json::array();
	for (const PassMedians &pass : p_passes) {
		Json &row = json.emplace_back(Json{ { "name", pass.name } });
		row.update(to_json(pass.cost));
		row["is_on_host"] = pass.is_on_host;
	}
	return json;
}

} // namespace gnomon
