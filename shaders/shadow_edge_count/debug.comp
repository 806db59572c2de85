#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
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
	const CountPixel pixel = count_pixel(subject, make_count_solids(count_subject_crossings(subject)));
	if (!pixel.is_receiver) {
		return;
	}
	imageStore(debug_image, ivec3(pixel.pixel, EDGE_COUNT_DEBUG_EDGES), vec4(pixel.edge_count));
	imageStore(debug_image, ivec3(pixel.pixel, EDGE_COUNT_DEBUG_SOLIDS),
			vec4(max(pixel.solid_count, 0)));
	imageStore(debug_image, ivec3(pixel.pixel, EDGE_COUNT_DEBUG_LEAVES), vec4(push.kind));
}
