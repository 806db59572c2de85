#include "modules/shadow_edge_count/count_time_budget.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Rates before the first measurement. That of GPUs is of a slow one: the first frames are coarse
// rather than late.
constexpr double CPU_COST_PER_MS = 2000;
constexpr double GPU_COST_PER_MS = 25'000;
constexpr double NEW_SHARE = 0.25; // of the newest frame in a mean
// The rate that is used follows the measured one only if they differ by more than the noise, so
// that the mask does not change with each frame.
constexpr double RATE_TOLERANCE = 1.2;
constexpr uint32_t MIN_COST = 2000; // less tells the rate of a few leaves, not that of the device

/// Whether the pass takes time in proportion to the cost of leaves.
bool counts_edges(const std::string &p_pass) {
	return (p_pass.find(": resolve") != std::string::npos && !p_pass.ends_with("resolve dark")) ||
			p_pass.ends_with(": count solids") || p_pass.ends_with(": filter");
}

void follow(double p_new, bool p_is_first, double &r_mean) {
	r_mean = p_is_first ? p_new : r_mean + NEW_SHARE * (p_new - r_mean);
}

} // namespace

CountTimeBudget::CountTimeBudget(bool p_runs_on_cpu) :
		cost_per_ms(p_runs_on_cpu ? CPU_COST_PER_MS : GPU_COST_PER_MS) {}

void CountTimeBudget::learn(std::span<const PassTiming> p_passes, uint32_t p_cost) {
	double counting_ms = 0;
	double new_other_ms = 0;
	for (const PassTiming &pass : p_passes) {
		(counts_edges(pass.name) ? counting_ms : new_other_ms) += pass.gpu_ms;
	}
	if (counting_ms <= 0 || p_cost < MIN_COST) {
		return;
	}
	const bool is_first = measured_cost_per_ms <= 0;
	follow(p_cost / counting_ms, is_first, measured_cost_per_ms);
	follow(new_other_ms, is_first, other_ms);
	const double ratio = measured_cost_per_ms / cost_per_ms;
	if (is_first || ratio > RATE_TOLERANCE || ratio < 1 / RATE_TOLERANCE) {
		cost_per_ms = measured_cost_per_ms;
	}
}

uint32_t CountTimeBudget::find_cost_limit(double p_budget_ms) const {
	return static_cast<uint32_t>(
			std::clamp((p_budget_ms - other_ms) * cost_per_ms, 0.0, double(1u << 31)));
}

} // namespace gnomon
