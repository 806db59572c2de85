// Planes of faces, and weights of edges: the float32 version of CountedCasters in
// modules/shadow_edge_count/count_in_double.h.
#ifndef COUNT_CLASSIFY_INC_GLSL
#define COUNT_CLASSIFY_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// A side of a face, scaled to length 1 without overflow or underflow; 0 for a side without length.
vec3 normalize_side(vec3 p_side) {
	const float size = max(abs(p_side.x), max(abs(p_side.y), abs(p_side.z)));
	return size > 0.0 ? normalize(p_side / size) : vec3(0.0);
}

/// The unit vector along p_normal without its component along p_axis (unit). 0 if nothing remains.
vec3 make_perpendicular(vec3 p_normal, vec3 p_axis) {
	const vec3 rest = p_normal - dot(p_normal, p_axis) * p_axis;
	const float length_rest = length(rest);
	return length_rest > 0.0 ? rest / length_rest : vec3(0.0);
}

/// The plane (n, c) of a face, n unit: n.r + c is 0 on the face and above 0 in front. All 0 for a face without area.
/// Computed once per face, so that all its edges use equal bits.
vec4 make_count_plane(vec3 p_a, vec3 p_b, vec3 p_c) {
	// Use the shortest side and the next one: the two long sides of a sliver are nearly parallel.
	const vec3 ab = p_b - p_a;
	const vec3 bc = p_c - p_b;
	const vec3 ca = p_a - p_c;
	const float square_ab = dot(ab, ab);
	const float square_bc = dot(bc, bc);
	const float square_ca = dot(ca, ca);
	const bool is_ab = square_ab <= square_bc && square_ab <= square_ca;
	const bool is_bc = square_bc <= square_ca;
	const vec3 shortest = normalize_side(is_ab ? ab : (is_bc ? bc : ca));
	const vec3 next = normalize_side(is_ab ? bc : (is_bc ? ca : ab));
	// Where the sides are parallel but for rounding, the product's direction is arbitrary. The plane must contain the
	// face's sides even so, since edges are dropped and weighed by the sides of their planes. Twice: the first result
	// may be mostly rounding.
	const vec3 normal = make_perpendicular(make_perpendicular(cross(shortest, next), next), next);
	return vec4(normal, -dot(normal, p_a));
}

/// +1 if the whole light is in front of the face's plane, -1 if it is behind, 0 if the plane crosses the light.
/// p_tolerance: maximum shift of the plane by rounding, in metres; directional: a cosine.
int count_find_light_side(bool p_is_directional, float p_radius, float p_tolerance, vec4 p_plane) {
	const float reach = p_radius * (p_is_directional ? length(p_plane.xy) : 1.0) + p_tolerance;
	const float side = p_is_directional ? -p_plane.z : p_plane.w;
	return side > reach ? 1 : (side < -reach ? -1 : 0);
}

/// Flags of an edge, unpacked from the words of its two faces; see CountEdgeRecord.
struct CountEdgeKind {
	bool is_double_sided;
	bool is_inconsistent;
	bool has_face1;
};

CountEdgeKind make_count_kind(uint p_face0, uint p_face1) {
	return CountEdgeKind((p_face0 & EDGE_COUNT_DOUBLE_SIDED) != 0u,
			(p_face0 & EDGE_COUNT_INCONSISTENT) != 0u, p_face1 != EDGE_COUNT_NO_FACE);
}

/// Signed weight of an edge: the change of the number of solids across it. A closed part counts as one solid from its
/// front to its back. In a part that is not closed (double-sided) each face counts as one, so that a silhouette edge
/// between two of its faces weighs 2; edges without a second face are in such parts only. p_is_in_front0,
/// p_is_in_front1: the viewpoint is in front of the first and of the second face (for an inconsistent edge: of the
/// second face's negated plane).
int count_sum_weights(bool p_is_in_front0, bool p_is_in_front1, CountEdgeKind p_kind) {
	const int first = p_is_in_front0 ? 1 : -1;
	const int sum = first - (p_is_in_front1 ? 1 : -1);
	return p_kind.has_face1 ? (p_kind.is_double_sided ? sum : sum / 2) : first;
}

#endif
