// Computes the vertices of a fin, for both fins.geom and edge_fins.vert.
#ifndef FIN_INC_GLSL
#define FIN_INC_GLSL

#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

// Sun et al. 2010, section 2.1.1: triangles BCC', C'B'B (outer), CBB'', B''C''C (inner), where
// X' = X + r N and X'' = X - t N. A corner is encoded in 3 bits: bit 0 selects C instead of B, bits 1 and 2 select the
// offset along the normal (FIN_ON_EDGE, FIN_OUTSIDE or FIN_INSIDE).
const uint FIN_ON_EDGE = 0u;
const uint FIN_OUTSIDE = 2u;
const uint FIN_INSIDE = 4u;
const uint FIN_OFFSET_MASK = 6u; // bits 1 and 2
const uint FIN_CORNERS[12] = uint[12](
	0u, 1u, 1u | FIN_OUTSIDE, 1u | FIN_OUTSIDE, FIN_OUTSIDE, 0u,
	1u, 0u, FIN_INSIDE, FIN_INSIDE, 1u | FIN_INSIDE, 1u);
const uint FIN_HALF_CORNER_COUNT = 6u; // in each half, outer or inner
const uint FIN_FIRST_OUTER_CORNER = 0u;	   // index of each half's first corner
const uint FIN_FIRST_INNER_CORNER = FIN_HALF_CORNER_COUNT;

/// Transition parameter theta of a corner: 1 at X', 0.5 on the edge, 0 at X''.
float fin_theta(uint p_corner) {
	const uint side = p_corner & FIN_OFFSET_MASK;
	return side == FIN_OUTSIDE ? 1.0 : side == FIN_INSIDE ? 0.0 : 0.5;
}

/// The unit vertex normal in light view space; a zero normal stays zero. Normals are transformed by
/// the cofactor matrix, which is finite for every transform.
vec3 fin_normal_view(FinsPush p_push, vec3 p_normal_node) {
	const vec3 x = p_push.view_from_node[0].xyz;
	const vec3 y = p_push.view_from_node[1].xyz;
	const vec3 z = p_push.view_from_node[2].xyz;
	precise const vec3 n = cross(y, z) * p_normal_node.x + cross(z, x) * p_normal_node.y +
			cross(x, y) * p_normal_node.z;
	const float size = max(abs(n.x), max(abs(n.y), abs(n.z)));
	// Divide by the largest component first: with a tiny scale, squares of the cofactors would underflow.
	precise const vec3 scaled = n / size;
	precise const float length2 = dot(scaled, scaled);
	return size > 0.0 ? scaled * (p_push.normal_sign / sqrt(length2)) : vec3(0.0);
}

/// Position of a corner in the light's clip space, projected as by LightView::compute_clip_from_view.
vec4 fin_position_clip(FinsViewConstants p_view, FinsPush p_push, uint p_corner,
		vec3 p_position_node, vec3 p_normal_node) {
	precise vec3 position = (p_push.view_from_node * vec4(p_position_node, 1.0)).xyz;
	const uint side = p_corner & FIN_OFFSET_MASK;
	if (side != FIN_ON_EDGE) {
		const float offset_m =
				side == FIN_OUTSIDE ? p_view.outer_width_m : -p_view.inner_width_m;
		position += offset_m * fin_normal_view(p_push, p_normal_node);
	}
	precise const vec2 xy = position.xy / p_view.half_extent;
	precise const float depth = (p_view.view_far_m - position.z) * p_view.depth_scale;
	return p_view.is_orthographic != 0u ? vec4(xy, depth, 1.0)
										: vec4(xy, p_view.depth_scale, position.z);
}

#endif
