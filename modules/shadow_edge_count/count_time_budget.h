#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/shadow_edge_count/count_status.h"

#include <cstdint>
#include <span>

namespace gnomon {

/// How much counting there is time for, learned from the times that earlier frames took. A frame's
/// time is that of the passes that do not count edges, plus the cost of all leaves (see
/// EDGE_COUNT_COST_UNIT) divided by a rate.
class CountTimeBudget {
public:
	explicit CountTimeBudget(bool p_runs_on_cpu);

	/// Learns from a finished frame. p_passes: its passes for the light. p_cost: of its leaves.
	/// Ignored unless passes that count edges were timed.
	void learn(std::span<const PassTiming> p_passes, uint32_t p_cost);
	/// The cost for which p_budget_ms is enough. 0: not even the other passes fit.
	uint32_t find_cost_limit(double p_budget_ms) const;

private:
	double cost_per_ms;
	double measured_cost_per_ms = 0; // mean of the last frames; 0: none yet
	double other_ms = 0;			 // of passes that do not count edges, mean of the last frames
};

} // namespace gnomon
