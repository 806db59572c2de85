#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_classify_inc.glsl"

// The planes of one caster's faces in the light view, once per face: see make_count_plane.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = FIND_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = FIND_BINDING_FACES) readonly buffer Faces {
	uint faces[]; // three vertices each
};
layout(std430, set = 0, binding = FIND_BINDING_PLANES) writeonly buffer Planes {
	vec4 planes_view[];
};
layout(push_constant) uniform Push {
	CountCasterPush push;
};

void main() {
	const uint face = gl_GlobalInvocationID.x;
	if (face >= push.face_count) {
		return;
	}
	vec3 corners[3];
	for (int i = 0; i < 3; ++i) {
		corners[i] = (push.view_from_node * vec4(positions_node[faces[3u * face + uint(i)]].xyz, 1.0)).xyz;
	}
	const vec4 plane = make_count_plane(corners[0], corners[1], corners[2]);
	planes_view[push.first_face + face] =
			(push.kind & uint(EDGE_COUNT_MIRRORED)) != 0u ? -plane : plane;
}
