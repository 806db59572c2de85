#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/compute_extensions_inc.glsl"
#include "shadow_edge_count/light_faces_inc.glsl"

// Lists the faces that may cut the light's disc. A single work group tests every face, so that the
// list is in the order of the faces.
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = COUNT_BINDING_TOTALS) writeonly buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = COUNT_BINDING_CUT_FACES) writeonly buffer CutFaces {
	uint cut_faces[];
};

const uint GROUP_SIZE = gl_WorkGroupSize.x;
shared uint are_cut[GROUP_SIZE];

/// Squared distance of the light's centre from the segment between two points.
float find_square_distance(vec3 p_a, vec3 p_b) {
	const vec3 along = p_b - p_a;
	const float fraction = clamp(-dot(p_a, along) / max(dot(along, along), 1e-37), 0.0, 1.0);
	const vec3 nearest = p_a + fraction * along;
	return dot(nearest, nearest);
}

/// True if the face comes within R of the light's centre. Always false if no caster's bounds do:
/// then max_cut_face_count is 0.
bool is_cut_face(CountFaceRecord p_face) {
	const float WIDENING = 1.001; // for rounding
	const vec3 a = uintBitsToFloat(p_face.a_kind.xyz);
	const vec3 b = uintBitsToFloat(p_face.b_first_distance.xyz);
	const vec3 c = uintBitsToFloat(p_face.c_end_distance.xyz);
	// Nearest is a point of a side, or the foot of the perpendicular if that is inside the face. The normal of a sliver
	// may be wrong, but the sliver's points are all near its sides.
	const float side_square = min(find_square_distance(a, b), min(find_square_distance(b, c), find_square_distance(c, a)));
	const vec3 normal = cross(b - a, c - a);
	const float normal_square = dot(normal, normal);
	const float height = dot(normal, a);
	const vec3 sides = vec3(dot(normal, cross(a, b)), dot(normal, cross(b, c)), dot(normal, cross(c, a)));
	const bool is_inside = all(greaterThanEqual(sides, vec3(0.0))) || all(lessThanEqual(sides, vec3(0.0)));
	const float plane_square = is_inside && normal_square > 1e-30 ? height * height / normal_square : side_square;
	const float radius = WIDENING * light.disc_radius;
	return light.max_cut_face_count > 0u && min(side_square, plane_square) <= radius * radius;
}

void main() {
	load_light();
	const uint invocation = gl_LocalInvocationID.x;
	uint count = 0u;
	for (uint first = 0u; first < light.face_count; first += GROUP_SIZE) {
		const uint face = first + invocation;
		are_cut[invocation] = face < light.face_count && is_cut_face(load_count_face(face)) ? 1u : 0u;
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
