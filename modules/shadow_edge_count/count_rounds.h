#pragma once

#include "modules/render_graph/compute_pass.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

#include <cstdint>
#include <vector>

namespace gnomon {

inline constexpr uint32_t EDGE_COUNT_BLOCK_PIXELS = EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX;

// Rounds: subgroups of receivers with very many edges are counted in several dispatches, see
// EDGE_COUNT_MAX_ITERATIONS.

/// The shape of the passes that count edges, see EDGE_COUNT_CONSTANT_IS_CPU.
struct CountShape {
	uint32_t subgroup_size = 8;
	uint32_t lanes_per_receiver = 1; // invocations
	uint32_t sets_per_lane = 1;		 // sets of 64 points on the light that an invocation counts
};
/// p_sample_set_count: all sets of the light, 1 or 4.
CountShape get_count_shape(const RenderingDevice &p_device, uint32_t p_sample_set_count);

struct CountRoundLimits {
	uint32_t slot_count = 0;  // subgroups that can be between two rounds at the same time
	uint32_t round_count = 0; // 0: no subgroup needs more iterations than one dispatch has
};
/// p_size_px: of the image. p_edge_count: number of edges of the casters.
CountRoundLimits choose_round_limits(
		glm::uvec2 p_size_px, uint32_t p_edge_count, const CountShape &p_shape);

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

CountRounds create_rounds_buffers(RenderGraph &r_graph, const shader::CountLightConstants &p_light,
		const CountShape &p_shape);

/// Adds a pass with all rounds, if there are any. p_pipeline: of resolve_unfinished.comp.
/// p_bindings: of the passes that count edges, and the mask.
void add_rounds_pass(RenderGraph &r_graph, const CountRounds &p_rounds, PipelineRID p_pipeline,
		const std::vector<PassBinding> &p_bindings);

} // namespace gnomon
