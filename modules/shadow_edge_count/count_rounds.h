#pragma once

#include "modules/render_graph/compute_pass.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <vector>

namespace gnomon {

// Rounds: subgroups of receivers with very many edges are counted in several dispatches, see
// EDGE_COUNT_MAX_ITERATIONS.

/// The size of the subgroups that count edges.
uint32_t get_count_subgroup_size(const RenderingDevice &p_device);

struct CountRoundLimits {
	uint32_t slot_count = 0;  // subgroups that can be between two rounds at the same time
	uint32_t round_count = 0; // 0: no subgroup needs more iterations than one dispatch has
};
/// p_size_px: of the image. p_edge_count: number of edges of the casters. p_sample_set_count: sets
/// of 64 points on the light, 1 or 4.
CountRoundLimits choose_round_limits(glm::uvec2 p_size_px, uint32_t p_edge_count,
		uint32_t p_subgroup_size, uint32_t p_sample_set_count);

/// The buffers of all rounds of a light.
struct CountRounds {
	RGBuffer counts;   // EDGE_COUNT_UNFINISHED_*
	RGBuffer items;	   // the queue of unfinished subgroups
	RGBuffer states;   // one per slot; only if there are rounds, as the following
	RGBuffer slots[2]; // of this round and of the next one, alternating
	/// Indirect dispatch arguments of each round, and of one more, which has no work groups.
	std::vector<RGBuffer> dispatches;

	/// Appends the bindings with which a pass adds unfinished subgroups, see
	/// count_unfinished_inc.glsl.
	void bind_queue(std::vector<PassBinding> &r_bindings) const;
	/// The buffers that must be cleared to 0 before the passes that add subgroups: the queue is
	/// empty.
	std::vector<RGBuffer> list_cleared() const;
};

CountRounds create_rounds_buffers(RenderGraph &r_graph, const RenderingDevice &p_device,
		const shader::CountLightConstants &p_light, uint32_t p_sample_set_count);

/// Adds a pass with all rounds, if there are any. p_pipeline: of resolve_unfinished.comp.
/// p_bindings: of the passes that count edges, and the mask.
void add_rounds_pass(RenderGraph &r_graph, const CountRounds &p_rounds, PipelineRID p_pipeline,
		const std::vector<PassBinding> &p_bindings);

} // namespace gnomon
