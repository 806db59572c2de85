#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/caster_edges_inc.glsl"
#include "shadow_edge_count/count_classify_inc.glsl"

// Marks the edges of the casters that receivers may have to count. Each invocation writes one word of 32
// edges, and each work group counts the marked edges of its run.
layout(local_size_x = FIND_GROUP_SIZE) in; // EDGE_COUNT_WORDS_PER_RUN
FETCHED_VEC4S(COUNT_BINDING_PLANES, planes_buffer);
layout(std430, set = 0, binding = FIND_BINDING_WORDS) writeonly buffer Words {
	uint words[];
};
layout(std430, set = 0, binding = FIND_BINDING_RUNS) writeonly buffer Runs {
	uint run_counts[];
};

shared uint edge_count;

int find_side(CountCasterRecord p_caster, uint p_face) {
	const uint face = p_caster.first_face + (p_face & EDGE_COUNT_FACE_MASK);
	return count_find_light_side(
			push.is_directional != 0u, push.disc_radius, push.side_tolerance, FETCH_VEC4(planes_buffer, face));
}

/// False if the whole light is on the same side of both faces, so that no point of it sees a silhouette. Always
/// true for a boundary edge.
bool may_be_silhouette(CountCasterRecord p_caster, CountMeshEdge p_edge) {
	const CountEdgeKind kind = make_count_kind(p_edge.face0, p_edge.face1);
	if (!kind.has_face1) {
		return true;
	}
	const int side0 = find_side(p_caster, p_edge.face0);
	const int side1 = find_side(p_caster, p_edge.face1);
	return side0 == 0 || side0 != (kind.is_inconsistent ? -side1 : side1);
}

void main() {
	const CountWorkGroup group = load_work_group();
	if (gl_LocalInvocationID.x == 0u) {
		edge_count = 0u;
	}
	barrier();
	const uint word_index = group.index * uint(EDGE_COUNT_WORDS_PER_RUN) + gl_LocalInvocationID.x;
	if (group.index != NO_GROUP && word_index < push.item_count) {
		const CountCasterRecord caster = load_caster(find_caster(group, /*p_is_word=*/true, word_index));
		const uint first = (word_index - caster.first_word) * uint(EDGE_COUNT_EDGES_PER_WORD);
		uint word = 0u;
		const uint count = min(uint(EDGE_COUNT_EDGES_PER_WORD), caster.edge_count - min(first, caster.edge_count));
		for (uint i = 0u; i < count; ++i) {
			word |= may_be_silhouette(caster, load_mesh_edge(caster, first + i)) ? 1u << i : 0u;
		}
		words[word_index] = word;
		atomicAdd(edge_count, uint(bitCount(word)));
	}
	barrier();
	if (gl_LocalInvocationID.x == 0u && group.index != NO_GROUP) {
		run_counts[group.index] = edge_count;
	}
}
