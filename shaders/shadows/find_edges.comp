#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "common/work_rows_inc.glsl"
#include "shared/silhouette_shared.h"

// Marks one caster's silhouette edges. Each invocation writes one word, with a bit for each of 32
// edges, and adds the number of silhouette edges in it to the count of the word's run.
layout(local_size_x = SILHOUETTE_WORDS_PER_RUN) in;
layout(std430, set = 0, binding = SILHOUETTE_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = SILHOUETTE_BINDING_EDGES) readonly buffer Edges {
	TopologyEdge edges[];
};
layout(std430, set = 0, binding = SILHOUETTE_BINDING_WORDS) writeonly buffer Words {
	uint edge_words[];
};
layout(std430, set = 0, binding = SILHOUETTE_BINDING_RUNS) buffer Runs {
	uint run_counts[];
};
layout(push_constant) uniform Push {
	SilhouettePush push;
};

bool is_silhouette(TopologyEdge p_edge) {
	return p_edge.opposite1 == TOPOLOGY_NO_VERTEX ||
			is_edge_record_silhouette(push.light_position_node, p_edge, positions_node[p_edge.a].xyz,
					positions_node[p_edge.b].xyz, positions_node[p_edge.opposite0].xyz,
					positions_node[get_second_opposite(p_edge)].xyz);
}

void main() {
	const uint word_index = find_work_item(uint(SILHOUETTE_WORDS_PER_RUN));
	const uint first_edge = word_index * SILHOUETTE_EDGES_PER_WORD;
	if (first_edge >= push.edge_count) {
		return;
	}
	uint word = 0u;
	const uint count = min(SILHOUETTE_EDGES_PER_WORD, push.edge_count - first_edge);
	for (uint i = 0u; i < count; ++i) {
		word |= is_silhouette(edges[first_edge + i]) ? 1u << i : 0u;
	}
	edge_words[push.first_word + word_index] = word;
	if (word != 0u) {
		atomicAdd(run_counts[push.first_run + word_index / SILHOUETTE_WORDS_PER_RUN],
				uint(bitCount(word)));
	}
}
