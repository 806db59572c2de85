#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/light_faces_inc.glsl"

// Lists the faces that may cut the light's disc. A single work group tests every face, so that the
// list is in the order of the faces.
layout(local_size_x = CUT_FACES_GROUP_SIZE) in;
layout(std140, set = 0, binding = CUT_FACES_BINDING_LIGHT) restrict readonly buffer Light {
	CountLightConstants light;
};
layout(std430, set = 0, binding = CUT_FACES_BINDING_TOTALS) writeonly buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = CUT_FACES_BINDING_LIST) writeonly buffer CutFaces {
	uint cut_faces[];
};

const uint GROUP_SIZE = uint(CUT_FACES_GROUP_SIZE);
shared uint are_cut[CUT_FACES_GROUP_SIZE];

void main() {
	const uint invocation = gl_LocalInvocationID.x;
	uint count = 0u;
	for (uint first = 0u; first < light.face_count; first += GROUP_SIZE) {
		const uint face = first + invocation;
		are_cut[invocation] = face < light.face_count && is_cut_face(light, load_face(face)) ? 1u : 0u;
		barrier();
		uint preceding_count = 0u;
		uint total_count = 0u;
		for (uint i = 0u; i < GROUP_SIZE; ++i) {
			preceding_count += i < invocation ? are_cut[i] : 0u;
			total_count += are_cut[i];
		}
		if (are_cut[invocation] != 0u) {
			cut_faces[count + preceding_count] = face;
		}
		count += total_count;
		barrier();
	}
	if (invocation == 0u) {
		totals[EDGE_COUNT_TOTAL_CUT_FACES] = count;
	}
}
