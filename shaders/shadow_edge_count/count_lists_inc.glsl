// The light's faces, and the lists of them, in texel buffers, which software drivers read a fifth faster than
// storage buffers. The block `light` comes first.
#ifndef COUNT_LISTS_INC_GLSL
#define COUNT_LISTS_INC_GLSL

#include "shadow_edge_count/count_faces_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_HEADS) uniform utextureBuffer heads_buffer;
layout(set = 0, binding = COUNT_BINDING_NODES) uniform utextureBuffer nodes_buffer;
layout(set = 0, binding = COUNT_BINDING_FACES) uniform utextureBuffer faces_buffer;
layout(set = 0, binding = COUNT_BINDING_PLANES) uniform textureBuffer planes_buffer;
layout(set = 0, binding = COUNT_BINDING_TOTALS) uniform utextureBuffer totals_buffer;
layout(set = 0, binding = COUNT_BINDING_CUT_FACES) uniform utextureBuffer cut_faces_buffer;

uint load_count_head(uint p_index) {
	return texelFetch(heads_buffer, int(p_index)).r;
}

uvec2 load_count_node(uint p_index) {
	return texelFetch(nodes_buffer, int(p_index)).rg;
}

uint load_count_level(uint p_view) {
	return texelFetch(totals_buffer, int(EDGE_COUNT_TOTAL_LEVELS + p_view)).r;
}

CountFaceRecord load_count_face(uint p_face) {
	const int first = int(3u * p_face);
	return CountFaceRecord(texelFetch(faces_buffer, first), texelFetch(faces_buffer, first + 1),
			texelFetch(faces_buffer, first + 2));
}

vec4 load_count_plane(uint p_face) {
	return texelFetch(planes_buffer, int(p_face));
}

/// Of the faces that may cut the light's disc.
uint find_cut_face_count() {
	return light.most_cut_faces == 0u
			? 0u
			: min(texelFetch(totals_buffer, int(EDGE_COUNT_TOTAL_CUT_FACES)).r, light.most_cut_faces);
}

uint load_cut_face(uint p_index) {
	return texelFetch(cut_faces_buffer, int(p_index)).r;
}

#endif
