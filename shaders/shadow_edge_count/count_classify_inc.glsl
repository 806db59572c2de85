// Planes of faces, and which edges receivers may have to count: CountedCasters in float32.
#ifndef COUNT_CLASSIFY_INC_GLSL
#define COUNT_CLASSIFY_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// A side of a face at length 1, whatever its scale; 0 of a side without length.
vec3 normalize_side(vec3 p_side) {
	const float size = max(abs(p_side.x), max(abs(p_side.y), abs(p_side.z)));
	return size > 0.0 ? normalize(p_side / size) : vec3(0.0);
}

/// n and d of a face, n unit: n.r + d = 0, above 0 in front. All 0 for a face without area. Made once
/// per face, so that both edges' sides of it are equal bit for bit.
vec4 make_count_plane(vec3 p_a, vec3 p_b, vec3 p_c) {
	// From the shortest side and the next: two long ones of a sliver hardly differ in direction.
	const vec3 ab = p_b - p_a;
	const vec3 bc = p_c - p_b;
	const vec3 ca = p_a - p_c;
	const float square_ab = dot(ab, ab);
	const float square_bc = dot(bc, bc);
	const float square_ca = dot(ca, ca);
	const bool is_ab = square_ab <= square_bc && square_ab <= square_ca;
	const bool is_bc = square_bc <= square_ca;
	const vec3 shortest = is_ab ? ab : (is_bc ? bc : ca);
	const vec3 next = is_ab ? bc : (is_bc ? ca : ab);
	const vec3 normal = cross(normalize_side(shortest), normalize_side(next));
	const float length_normal = length(normal);
	const vec3 unit = length_normal > 0.0 ? normal / length_normal : vec3(0.0);
	return vec4(unit, -dot(unit, p_a));
}

/// +1 when the whole light is in front of the face, -1 when behind it, 0 when it is divided.
/// p_tolerance: what rounding may move the face's plane; metres, directional: a cosine.
int count_find_light_side(bool p_is_directional, float p_radius, float p_tolerance, vec4 p_plane) {
	const float reach = p_radius * (p_is_directional ? length(p_plane.xy) : 1.0) + p_tolerance;
	const float side = p_is_directional ? -p_plane.z : p_plane.w;
	return side > reach ? 1 : (side < -reach ? -1 : 0);
}

/// What an edge's word for its first face holds; see CountEdgeRecord.
struct CountEdgeKind {
	bool is_double_sided;
	bool is_inconsistent;
	bool has_face1;
};

CountEdgeKind make_count_kind(uint p_face0, uint p_face1) {
	return CountEdgeKind((p_face0 & EDGE_COUNT_DOUBLE_SIDED) != 0u,
			(p_face0 & EDGE_COUNT_INCONSISTENT) != 0u, p_face1 != EDGE_COUNT_NO_FACE);
}

/// Signed weight: how the number of solids changes across the edge, for a viewpoint that is in front of the
/// first face or not, and of the second (of an inconsistent one: of its negated plane).
int count_sum_weights(bool p_is_before0, bool p_is_before1, CountEdgeKind p_kind) {
	const int first = p_is_before0 ? 1 : -1;
	const int sum = first - (p_is_before1 ? 1 : -1);
	return p_kind.has_face1 ? (p_kind.is_double_sided ? sum : sum / 2) : first;
}

#endif
