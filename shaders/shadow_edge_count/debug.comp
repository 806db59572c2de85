#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/count_resolve_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2DArray
		debug_image;

// Writes the layers of the debug image (EDGE_COUNT_DEBUG_*): the number of edges and of solids that
// each pixel counts, and the kind of its leaf.
void main() {
	load_count_constants();
	bool is_valid;
	const uint leaf = find_group_leaf(is_valid);
	const CountSubject subject = load_group_subject(leaf, is_valid);
	const int solids = pack_solids(count_subject_crossings(subject));
	bool is_unfinished; // never: there is no limit of iterations
	const CountState state = count_receiver(subject, solids, is_unfinished);
	if (!subject.is_receiver) {
		return;
	}
	imageStore(debug_image, ivec3(subject.pixel, EDGE_COUNT_DEBUG_EDGES), vec4(state.edge_count));
	imageStore(debug_image, ivec3(subject.pixel, EDGE_COUNT_DEBUG_SOLIDS), vec4(max(unpack_solid_count(solids), 0)));
	imageStore(debug_image, ivec3(subject.pixel, EDGE_COUNT_DEBUG_LEAVES), vec4(push.kind));
}
