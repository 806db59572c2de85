#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/ordered_list_inc.glsl"
#include "shadow_edge_count/caster_edges_inc.glsl"

// Writes the marked edges of one caster to the light's list, after those of the preceding casters
// and in mesh order, so that no sum depends on scheduling. One invocation per word. The last
// caster's pass writes the total number of edges.
layout(local_size_x = EDGE_COUNT_WORDS_PER_BLOCK) in;
FETCHED_UINTS(FIND_BINDING_WORDS, words_buffer);
FETCHED_UINTS(FIND_BINDING_BLOCKS, block_counts_buffer);
layout(std430, set = 0, binding = FIND_BINDING_EDGES) writeonly buffer Edges {
	CountEdgeRecord edges[];
};
layout(std430, set = 0, binding = FIND_BINDING_TOTALS) writeonly buffer Totals {
	uint totals[];
};

uint load_list_word(uint p_index) {
	return FETCH_UINT(words_buffer, p_index);
}

uint load_list_block(uint p_index) {
	return FETCH_UINT(block_counts_buffer, p_index);
}

CountEdgeRecord make_record(CountMeshEdge p_edge) {
	const bool is_mirrored = (push.flags & EDGE_COUNT_CASTER_MIRRORED) != 0u;
	const vec3 a = load_light_position(is_mirrored ? p_edge.b : p_edge.a);
	const vec3 b = load_light_position(is_mirrored ? p_edge.a : p_edge.b);
	return CountEdgeRecord(uvec4(floatBitsToUint(a), p_edge.face0 + push.first_face),
			uvec4(floatBitsToUint(b),
					p_edge.face1 == EDGE_COUNT_NO_FACE ? EDGE_COUNT_NO_FACE
													   : p_edge.face1 + push.first_face));
}

void main() {
	const uint word_index = gl_GlobalInvocationID.x;
	const uint word_count = (push.edge_count + uint(EDGE_COUNT_EDGES_PER_WORD) - 1u) /
			uint(EDGE_COUNT_EDGES_PER_WORD);
	const uint first_word = gl_WorkGroupID.x * uint(EDGE_COUNT_WORDS_PER_BLOCK);
	// Counts the edges of all preceding blocks, including those of other casters: there is one list for all.
	uint index = find_list_index(uint(EDGE_COUNT_WORDS_PER_BLOCK), 0u, push.first_block + gl_WorkGroupID.x,
			push.first_word + first_word, push.first_word + min(word_index, word_count));
	if (word_index >= word_count) {
		return;
	}
	for (uint bits = load_list_word(push.first_word + word_index); bits != 0u; bits &= bits - 1u) {
		edges[index] = make_record(
				load_mesh_edge(word_index * uint(EDGE_COUNT_EDGES_PER_WORD) + uint(findLSB(bits))));
		++index;
	}
	if ((push.flags & EDGE_COUNT_CASTER_LAST) != 0u && word_index + 1u == word_count) {
		totals[EDGE_COUNT_TOTAL_EDGES] = index;
	}
}
