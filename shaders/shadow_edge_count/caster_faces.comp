#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/caster_positions_inc.glsl"
#include "shadow_edge_count/count_classify_inc.glsl"

// Computes the vertices and planes of one caster's faces in light space. One invocation per face.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = FIND_BINDING_MESH_FACES) readonly buffer MeshFaces {
	CountMeshFace mesh_faces[];
};
layout(std430, set = 0, binding = FIND_BINDING_PLANES) writeonly buffer Planes {
	vec4 planes[];
};
layout(std430, set = 0, binding = FIND_BINDING_FACES) writeonly buffer Faces {
	CountFaceRecord faces[];
};

void main() {
	const uint index = gl_GlobalInvocationID.x;
	if (index >= push.face_count) {
		return;
	}
	const CountMeshFace face = mesh_faces[index];
	const vec3 a = load_light_position(face.a);
	const vec3 b = load_light_position(face.b);
	const vec3 c = load_light_position(face.c);
	const vec4 plane = make_count_plane(a, b, c);
	const bool is_mirrored = (push.flags & EDGE_COUNT_CASTER_MIRRORED) != 0u;
	planes[push.first_face + index] = is_mirrored ? -plane : plane;
	// Mirroring inverts the winding, so two vertices are swapped to match the plane's front.
	faces[push.first_face + index] = CountFaceRecord(uvec4(floatBitsToUint(a), face.kind),
			uvec4(floatBitsToUint(is_mirrored ? c : b), 0u), uvec4(floatBitsToUint(is_mirrored ? b : c), 0u));
}
