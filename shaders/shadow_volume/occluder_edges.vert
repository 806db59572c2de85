#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_volume/culling_shared.h"

// An occluder's edges, as wide as all texels that they touch. Beyond a silhouette light passes: nothing
// may be hidden there. At another edge the surface goes on, on the two faces' planes: the texel's centre
// is on one of them only, so that the farther one counts here. A texel that several edges touch gets
// the farthest of theirs.
layout(std430, set = 0, binding = CULLING_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = CULLING_BINDING_EDGES) readonly buffer Edges {
	TopologyEdge edges[];
};
layout(push_constant) uniform Push {
	OccluderPush push;
};

// Half a texel's diagonal is 0.71; the rest is for what is drawn elsewhere and rounds otherwise.
const float HALF_WIDTH_PX = 1.5;
const float BEYOND_VIEW = 1.1;
// Edges before the near plane count still: a face that reaches it may be drawn in the same texel. One
// that comes so near within a texel has no bound there.
const float MOST_DEPTH = 2.0;
// From a point on the edge to any point of a texel within the half width, with what the interpolation
// along the widened edge adds.
const float REACH_PX = 4.0;
const float ROUNDING = 1e-5;
const float LEAST_DETERMINANT = 1e-3; // of unit rows: planes seen edge-on have no usable slope

vec4 project(uint p_vertex) {
	return push.clip_from_node * vec4(positions_node[p_vertex].xyz, 1.0);
}

/// The greatest change of depth from a point on a face to another REACH_PX away.
float compute_change(vec4 p_a, vec4 p_b, vec4 p_c) {
	// depth w = slope . (x, y, w) at each corner, also of those behind the light
	mat3 rows;
	vec3 depths;
	const vec4 corners[3] = vec4[3](p_a, p_b, p_c);
	for (int i = 0; i < 3; ++i) {
		const float scale = 1.0 / max(length(corners[i].xyw), 1e-30);
		rows[i] = corners[i].xyw * scale;
		depths[i] = corners[i].z * scale;
	}
	if (!(abs(determinant(rows)) > LEAST_DETERMINANT)) {
		return 1.0;
	}
	const vec3 slope = inverse(transpose(rows)) * depths;
	return length(slope.xy) * 2.0 / float(CULLING_MAP_SIZE_PX) * REACH_PX;
}

/// Reversed; what is before the near plane is at 1.
float get_depth(vec4 p_clip) {
	return p_clip.z >= p_clip.w ? 1.0 : max(p_clip.z / p_clip.w, 0.0);
}

/// Keeps the part of a segment, given by its ends' positions on it, on which a height is not negative.
void clip(float p_at_a, float p_at_b, inout vec2 r_part) {
	const float crossing = p_at_a == p_at_b ? 0.0 : p_at_a / (p_at_a - p_at_b);
	if (p_at_a < 0.0) {
		r_part.x = p_at_b < 0.0 ? 2.0 : max(r_part.x, crossing);
	} else if (p_at_b < 0.0) {
		r_part.y = min(r_part.y, crossing);
	}
}

vec2 to_pixels(vec4 p_clip) {
	return (p_clip.xy / p_clip.w * 0.5 + 0.5) * float(CULLING_MAP_SIZE_PX);
}

void main() {
	const uint index = uint(gl_VertexIndex);
	const TopologyEdge edge = edges[index / 6u];
	const vec3 a_node = positions_node[edge.a].xyz;
	const vec3 b_node = positions_node[edge.b].xyz;
	const vec4 a = project(edge.a);
	const vec4 b = project(edge.b);
	vec2 part = vec2(0.0, 1.0);
	clip(MOST_DEPTH * a.w - a.z, MOST_DEPTH * b.w - b.z, part);
	for (int axis = 0; axis < 2; ++axis) {
		clip(BEYOND_VIEW * a.w - a[axis], BEYOND_VIEW * b.w - b[axis], part);
		clip(BEYOND_VIEW * a.w + a[axis], BEYOND_VIEW * b.w + b[axis], part);
	}
	if (part.x > part.y) {
		gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
		return;
	}
	const vec4 begin = mix(a, b, part.x);
	const vec4 end = mix(a, b, part.y);
	const uint corner = uint[6](0u, 1u, 2u, 2u, 1u, 3u)[index % 6u];
	const bool is_at_end = (corner & 1u) != 0u;
	float depth = 0.0;
	if (edge.opposite1 != TOPOLOGY_NO_VERTEX) {
		const uint opposite1 = get_second_opposite(edge);
		if (!is_edge_record_silhouette(push.light_node, edge, a_node, b_node,
					positions_node[edge.opposite0].xyz, positions_node[opposite1].xyz)) {
			const vec4 c = project(edge.opposite0);
			const vec4 d = project(opposite1);
			const float change = max(compute_change(a, b, c), compute_change(b, a, d));
			const float farthest = min(min(get_depth(a), get_depth(b)), min(get_depth(c), get_depth(d)));
			depth = max(get_depth(is_at_end ? end : begin) - change, farthest * (1.0 - ROUNDING));
		}
	}
	const vec2 begin_px = to_pixels(begin);
	const vec2 end_px = to_pixels(end);
	const float length_px = distance(begin_px, end_px);
	const vec2 along = length_px > 1e-4 ? (end_px - begin_px) / length_px : vec2(1.0, 0.0);
	const vec2 across = vec2(-along.y, along.x);
	const vec2 position_px = (is_at_end ? end_px + along * HALF_WIDTH_PX : begin_px - along * HALF_WIDTH_PX) +
			across * ((corner & 2u) == 0u ? -HALF_WIDTH_PX : HALF_WIDTH_PX);
	gl_Position = vec4(position_px / float(CULLING_MAP_SIZE_PX) * 2.0 - 1.0, depth, 1.0);
}
