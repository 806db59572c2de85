#include "modules/shadow_edge_count/count_status.h"

#include "modules/core/log.h"
#include "modules/core/text.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

namespace {

/// By bit of a fault: kinds of leaves that are resolved, then EDGE_COUNT_PASS_LIST_LEAVES.
const char *const PASS_NAMES[] = { "resolve dark", "count solids", "resolve",
	"resolve without lists", "filter", "resolve smooth", "list leaves" };

struct FaultKind {
	uint32_t bits;
	const char *what;
	const char *next_step;
};

const FaultKind FAULT_KINDS[] = {
	{ EDGE_COUNT_FAULT_LOOP, "the driver ended a loop before all edges were counted",
			"Make the light smaller, let fewer casters cast shadows, or set edge_count_budget; on "
			"llvmpipe an invocation makes at most 65535 iterations." },
	{ EDGE_COUNT_FAULT_TREE, "a walk through a tree of faces or edges has no end",
			"Please report it with the scene and the device; another shadow_technique avoids it." },
	{ EDGE_COUNT_FAULT_LIST, "a list of faces or edges has an index out of range",
			"Please report it with the scene and the device; another shadow_technique avoids it." },
};

} // namespace

std::vector<std::string> describe_count_faults(uint32_t p_faults, const std::string &p_light) {
	std::vector<std::string> lines;
	for (const FaultKind &kind : FAULT_KINDS) {
		for (uint32_t pass = 0; pass < std::size(PASS_NAMES); ++pass) {
			if ((p_faults & kind.bits << pass) != 0) {
				lines.push_back(text("Light \"", p_light, "\", edge_count, pass \"",
						PASS_NAMES[pass], "\": ", kind.what, ". Some of its shadows are wrong. ",
						kind.next_step));
			}
		}
	}
	return lines;
}

void CountStatus::add_read_back(
		RenderGraph &r_graph, RGBuffer p_status, const std::string &p_light) {
	const auto receive = [latest = latest, light = p_light](std::span<const uint8_t> p_bytes) {
		std::array<uint32_t, EDGE_COUNT_STATUS_WORDS> words;
		std::memcpy(words.data(), p_bytes.data(), sizeof(words));
		latest->words = words;
		const uint32_t faults = words[EDGE_COUNT_STATUS_FAULTS];
		for (const std::string &line :
				describe_count_faults(faults & ~latest->logged_faults, light)) {
			log_fault(line);
		}
		latest->logged_faults |= faults;
	};
	r_graph.add_pass("read edge count status")
			.reads(p_status, Access::COPY_READ)
			.keep()
			.execute([=](PassContext &p_context) {
				p_context.get_device().read_back(p_context.get(p_status), receive);
			});
}

void CountStatus::get_counters(std::vector<WorkCounter> &r_counters) const {
	if (latest->words) {
		r_counters.push_back({ "listed_edges", (*latest->words)[EDGE_COUNT_STATUS_LISTED_EDGES] });
		r_counters.push_back({ "longest_list", (*latest->words)[EDGE_COUNT_STATUS_LONGEST_LIST] });
		r_counters.push_back({ "rays", (*latest->words)[EDGE_COUNT_STATUS_RAYS] });
		r_counters.push_back({ "leaves", (*latest->words)[EDGE_COUNT_STATUS_LEAVES] });
		r_counters.push_back({ "longest_walk", (*latest->words)[EDGE_COUNT_STATUS_LONGEST_WALK] });
		r_counters.push_back(
				{ "longest_count", (*latest->words)[EDGE_COUNT_STATUS_LONGEST_COUNT] });
	}
	if (const std::optional<CountRungs> rungs = get_rungs()) {
		r_counters.push_back({ "cost", rungs->cost });
		for (uint32_t rung = 0; rung < EDGE_COUNT_RUNG_COUNT; ++rung) {
			r_counters.push_back({ text("leaves_on_rung_", rung), rungs->leaf_counts[rung] });
		}
	}
}

std::optional<CountRungs> CountStatus::get_rungs() const {
	if (!latest->words || (*latest->words)[EDGE_COUNT_STATUS_COST] == 0) {
		return {};
	}
	CountRungs rungs = { .cost = (*latest->words)[EDGE_COUNT_STATUS_COST], .leaf_counts = {} };
	std::copy_n(latest->words->begin() + EDGE_COUNT_STATUS_RUNGS, EDGE_COUNT_RUNG_COUNT,
			rungs.leaf_counts.begin());
	return rungs;
}

} // namespace gnomon
