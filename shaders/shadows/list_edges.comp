#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/ordered_list_inc.glsl"
#include "common/work_rows_inc.glsl"
#include "shared/silhouette_shared.h"

// Writes the indices of one caster's silhouette edges into a list, and the arguments of the indirect draw that uses it.
// The order is ascending, so that the image does not depend on scheduling. One invocation per word of 32 edges.
layout(local_size_x = SILHOUETTE_WORDS_PER_RUN) in;
layout(std430, set = 0, binding = SILHOUETTE_BINDING_WORDS) readonly buffer Words {
	uint edge_words[];
};
layout(std430, set = 0, binding = SILHOUETTE_BINDING_RUNS) readonly buffer Runs {
	uint run_counts[];
};
layout(std430, set = 0, binding = SILHOUETTE_BINDING_LIST) writeonly buffer List {
	uint edge_list[];
};
layout(std430, set = 0, binding = SILHOUETTE_BINDING_DRAWS) writeonly buffer Draws {
	SilhouetteDraw draws[];
};
layout(push_constant) uniform Push {
	SilhouettePush push;
};

uint load_list_word(uint p_index) {
	return edge_words[p_index];
}

uint load_list_run(uint p_index) {
	return run_counts[p_index];
}

void main() {
	const uint word_index = find_work_item(uint(SILHOUETTE_WORDS_PER_RUN));
	const uint word_count = (push.edge_count + SILHOUETTE_EDGES_PER_WORD - 1u) / SILHOUETTE_EDGES_PER_WORD;
	// A dispatch in rows may have groups too many.
	const uint group = min(find_work_group(), (max(word_count, 1u) - 1u) / uint(SILHOUETTE_WORDS_PER_RUN));
	const uint first_word = group * SILHOUETTE_WORDS_PER_RUN;
	// Index, within the caster's part of the list, of the word's next silhouette edge.
	uint index = find_list_index(SILHOUETTE_WORDS_PER_RUN, push.first_run,
			push.first_run + group, push.first_word + first_word, push.first_word + min(word_index, word_count));
	if (word_index >= word_count) {
		return;
	}
	for (uint bits = edge_words[push.first_word + word_index]; bits != 0u; bits &= bits - 1u) {
		const uint bit = uint(findLSB(bits));
		edge_list[push.first_in_list + index] = word_index * SILHOUETTE_EDGES_PER_WORD + bit;
		++index;
	}
	if (word_index + 1u == word_count) {
		// After the last word, index is the number of the caster's silhouette edges.
		draws[push.draw_index] = SilhouetteDraw(index * push.vertices_per_edge, 1u, 0u, 0u);
	}
}
