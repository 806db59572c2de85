#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/rungs_inc.glsl"

// Chooses the position of the light's ladder: the lowest one at which the cost of all leaves is within the limit. It stays
// where it was while it is within the limit, and only moves back when the cost there leaves a margin, so that a cost
// near the limit does not change the mask in each frame.
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = COUNT_BINDING_COUNTS) buffer Counts {
	uint counts[]; // EDGE_COUNT_COUNT_*
};
layout(std430, set = 0, binding = COUNT_BINDING_STATUS) buffer Status {
	uint status[]; // EDGE_COUNT_STATUS_*
};
layout(std430, set = 0, binding = COUNT_BINDING_LADDER) buffer Ladder {
	uint last_ladder; // of the frame before
};
layout(std430, set = 0, binding = COUNT_BINDING_ARGUMENTS) buffer Arguments {
	uint arguments[]; // EDGE_COUNT_ARGUMENT_WORDS for each dispatch
};
layout(push_constant) uniform Push {
	CountRungsPush push;
};

const float FEW_PIXELS_SHARE = 0.33; // the cost of a leaf, of that on the rung above

/// The expected cost of all leaves. r_leaves: the number of leaves on each rung.
float find_cost(uint p_ladder, out uvec4 r_leaves) {
	float sum = 0.0;
	r_leaves = uvec4(0u);
	for (uint i = 0u; i < COST_CLASSES; ++i) {
		const uint rung = find_rung(i, p_ladder, push.first_rung);
		const uint leaf_count = counts[uint(EDGE_COUNT_COUNT_COST_LEAVES) + i];
		const vec4 shares = vec4(1.0, push.few_points_share, push.few_points_share * FEW_PIXELS_SHARE, 0.0);
		sum += float(counts[uint(EDGE_COUNT_COUNT_COSTS) + i]) * shares[rung];
		sum += rung == uint(EDGE_COUNT_RUNG_FILTERED) ? float(EDGE_COUNT_COST_OF_FILTER) * float(leaf_count) : 0.0;
		r_leaves[rung] += leaf_count;
	}
	return sum;
}

/// Copies the arguments of each kind of leaves for each rung that has leaves.
void write_arguments(uvec4 p_leaf_counts) {
	const uint words = uint(EDGE_COUNT_ARGUMENT_WORDS);
	for (uint i = 0u; i < uint(EDGE_COUNT_RUNG_COUNT * EDGE_COUNT_LEAF_KINDS); ++i) {
		const uint rung = i / uint(EDGE_COUNT_LEAF_KINDS);
		const uint kind = i % uint(EDGE_COUNT_LEAF_KINDS);
		const bool has_next = kind == uint(EDGE_COUNT_LEAVES_SMOOTH) && rung == uint(EDGE_COUNT_RUNG_FEW_POINTS);
		const uint count = p_leaf_counts[rung] + (has_next ? p_leaf_counts[EDGE_COUNT_RUNG_FEW_PIXELS] : 0u);
		for (uint word = 0u; word < words; ++word) {
			arguments[words * EDGE_COUNT_RUNG_ARGUMENTS(rung, kind) + word] =
					count > 0u ? arguments[words * kind + word] : 0u;
		}
	}
}

void main() {
	const float HYSTERESIS = 0.8;
	const uint first = push.first_rung * LOWERED_CLASSES;
	const uint last = clamp(last_ladder, first, LADDER_END);
	uvec4 leaf_counts;
	uint ladder = last;
	float cost = find_cost(last, leaf_counts);
	// Towards the end while the cost is above the limit, else towards the beginning while it leaves a margin.
	const float limit = float(push.cost_limit);
	const bool is_above = cost > limit;
	for (uint i = 0u; i < LADDER_END; ++i) {
		const uint next = is_above ? min(ladder + 1u, LADDER_END) : max(ladder, first + 1u) - 1u;
		uvec4 next_counts;
		const float next_cost = find_cost(next, next_counts);
		const bool moves = next != ladder && (is_above ? cost > limit : next_cost <= HYSTERESIS * limit);
		if (!moves) {
			break;
		}
		ladder = next;
		cost = next_cost;
		leaf_counts = next_counts;
	}
	write_arguments(leaf_counts);
	last_ladder = ladder;
	counts[EDGE_COUNT_COUNT_LADDER] = ladder | push.first_rung << EDGE_COUNT_FIRST_RUNG_SHIFT;
	status[EDGE_COUNT_STATUS_COST] = uint(min(cost, 4e9));
	for (uint i = 0u; i < uint(EDGE_COUNT_RUNG_COUNT); ++i) {
		status[EDGE_COUNT_STATUS_RUNGS + i] = leaf_counts[i];
	}
}
