#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/shadows/shadow_technique.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// Of a light with a time budget, see EDGE_COUNT_RUNG_FULL.
struct CountRungs {
	uint32_t cost = 0; // of all leaves on their rungs
	std::array<uint32_t, EDGE_COUNT_RUNG_COUNT> leaf_counts = {};
};

/// What the passes over leaves reported of themselves: faults, and counts of their work. Read back
/// without waiting, so it is that of a frame whose submission has finished.
class CountStatus {
public:
	/// Adds a pass that reads p_status (EDGE_COUNT_STATUS_*) back. When the values arrive, each
	/// kind of fault of each pass is logged once (log_fault), with the light's name.
	void add_read_back(RenderGraph &r_graph, RGBuffer p_status, const std::string &p_light);
	/// Appends the counts of the newest frame that was read back, if any.
	void get_counters(std::vector<WorkCounter> &r_counters) const;
	/// The rungs of the newest frame that was read back, if that had a time budget.
	std::optional<CountRungs> get_rungs() const;

private:
	/// Shared with the callbacks, which may arrive after this object is gone.
	struct Latest {
		std::optional<std::array<uint32_t, EDGE_COUNT_STATUS_WORDS>> words;
		uint32_t logged_faults = 0;
	};
	std::shared_ptr<Latest> latest = std::make_shared<Latest>();
};

/// The text of one line per fault in the word EDGE_COUNT_STATUS_FAULTS: what is incomplete, in
/// which pass, and what to do.
std::vector<std::string> describe_count_faults(uint32_t p_faults, const std::string &p_light);

} // namespace gnomon
