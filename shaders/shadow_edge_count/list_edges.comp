#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "common/ordered_list_inc.glsl"
#include "shadow_edge_count/caster_edges_inc.glsl"

// Writes the marked edges of all casters to the light's list, in the casters' order and in mesh order, so that no sum
// depends on scheduling. One invocation per word. That of the last word writes the total number of edges.
layout(local_size_x = FIND_GROUP_SIZE) in; // EDGE_COUNT_WORDS_PER_RUN
FETCHED_UINTS(FIND_BINDING_WORDS, words_buffer);
FETCHED_UINTS(FIND_BINDING_RUNS, run_counts_buffer);
layout(std430, set = 0, binding = COUNT_BINDING_EDGES) writeonly buffer Edges {
	CountEdgeRecord edges[];
};
layout(std430, set = 0, binding = COUNT_BINDING_TOTALS) writeonly buffer Totals {
	uint totals[];
};

uint load_list_word(uint p_index) {
	return FETCH_UINT(words_buffer, p_index);
}

uint load_list_run(uint p_index) {
	return FETCH_UINT(run_counts_buffer, p_index);
}

CountEdgeRecord make_record(CountCasterRecord p_caster, CountMeshEdge p_edge) {
	const bool is_mirrored = (p_caster.flags & EDGE_COUNT_CASTER_MIRRORED) != 0u;
	const vec3 a = load_light_position(p_caster, is_mirrored ? p_edge.b : p_edge.a);
	const vec3 b = load_light_position(p_caster, is_mirrored ? p_edge.a : p_edge.b);
	return CountEdgeRecord(uvec4(floatBitsToUint(a), p_edge.face0 + p_caster.first_face),
			uvec4(floatBitsToUint(b),
					p_edge.face1 == EDGE_COUNT_NO_FACE ? EDGE_COUNT_NO_FACE
													   : p_edge.face1 + p_caster.first_face));
}

void main() {
	const CountWorkGroup group = load_work_group();
	const uint run = group.index == NO_GROUP ? 0u : group.index;
	const uint first_word = run * uint(EDGE_COUNT_WORDS_PER_RUN);
	const uint word_index = min(first_word + gl_LocalInvocationID.x, push.item_count);
	// Counts the edges of all preceding runs: there is one list for all casters.
	uint index = find_list_index(uint(FIND_GROUP_SIZE), 0u, run, first_word, word_index);
	if (group.index == NO_GROUP || word_index >= push.item_count) {
		return;
	}
	const CountCasterRecord caster = load_caster(find_caster(group, /*p_is_word=*/true, word_index));
	const uint first_edge = (word_index - caster.first_word) * uint(EDGE_COUNT_EDGES_PER_WORD);
	// The capacity limits what other passes counted. (Godot does not know the length of an array.)
	for (uint bits = load_list_word(word_index); bits != 0u && index < push.max_edge_count; bits &= bits - 1u) {
		edges[index] = make_record(caster, load_mesh_edge(caster, first_edge + uint(findLSB(bits))));
		++index;
	}
	if (word_index + 1u == push.item_count) {
		totals[EDGE_COUNT_TOTAL_EDGES] = index;
	}
}
