#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/silhouette_inc.glsl"
#include "shadow_volume/culling_shared.h"

// Draws an occluder's edges, widened to cover all texels that they touch, to correct the depths there. Light passes a
// silhouette edge, so its texels may hide nothing: depth 0. At any other edge two faces meet, but the texel's centre
// was drawn with the depth of only one of them, so a depth behind both is written. A texel that several edges touch
// gets the farthest of their depths.
layout(std430, set = 0, binding = CULLING_BINDING_POSITIONS) readonly buffer Positions {
	vec4 positions_node[];
};
layout(std430, set = 0, binding = CULLING_BINDING_EDGES) readonly buffer Edges {
	TopologyEdge edges[];
};
layout(push_constant) uniform Push {
	OccluderPush push;
};

// Half a texel's diagonal is 0.71; the rest allows for the faces, whose rasterisation rounds differently.
const float HALF_WIDTH_PX = 1.5;
const float VIEW_CLIP_LIMIT = 1.1; // edges are clipped at this multiple of the view's extent
// Edges are clipped at this reversed depth. Edges slightly nearer than the near plane (depth 1) are still drawn,
// because a face that crosses the near plane may cover the same texel. A face that gets nearer than this within a texel
// hides nothing there anyway.
const float MAX_DEPTH = 2.0;
// Largest distance from a point on the edge to any point of the texels that the widened edge covers, including the
// error of interpolating the depth along it.
const float REACH_PX = 4.0;
const float ROUNDING = 1e-5; // relative error of depths
const float MIN_DETERMINANT = 1e-3; // of unit rows: planes seen edge-on have no usable slope

vec4 project(uint p_vertex) {
	return push.clip_from_node * vec4(positions_node[p_vertex].xyz, 1.0);
}

/// Largest change of depth between two points of a face that are REACH_PX texels apart; 1 if it cannot be computed.
float compute_depth_change(vec4 p_a, vec4 p_b, vec4 p_c) {
	// z = slope . (x, y, w) in homogeneous coordinates at each corner, also for corners behind the light
	mat3 rows; // stored as columns, hence the transpose below
	vec3 depths;
	const vec4 corners[3] = vec4[3](p_a, p_b, p_c);
	for (int i = 0; i < 3; ++i) {
		const float scale = 1.0 / max(length(corners[i].xyw), 1e-30);
		rows[i] = corners[i].xyw * scale;
		depths[i] = corners[i].z * scale;
	}
	if (!(abs(determinant(rows)) > MIN_DETERMINANT)) {
		return 1.0;
	}
	const vec3 slope = inverse(transpose(rows)) * depths;
	return length(slope.xy) * 2.0 / float(CULLING_MAP_SIZE_PX) * REACH_PX;
}

/// Reversed depth, 0..1; points nearer than the near plane are at 1.
float get_depth(vec4 p_clip) {
	return p_clip.z >= p_clip.w ? 1.0 : max(p_clip.z / p_clip.w, 0.0);
}

/// Shrinks r_range, the range (begin, end) of a segment in 0..1, to where a linear function is not negative. p_at_a,
/// p_at_b: the function's values at 0 and 1. If nothing remains, r_range.x > r_range.y.
void clip_range(float p_at_a, float p_at_b, inout vec2 r_range) {
	const float crossing = p_at_a == p_at_b ? 0.0 : p_at_a / (p_at_a - p_at_b);
	if (p_at_a < 0.0) {
		r_range.x = p_at_b < 0.0 ? 2.0 : max(r_range.x, crossing);
	} else if (p_at_b < 0.0) {
		r_range.y = min(r_range.y, crossing);
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
	vec2 edge_range = vec2(0.0, 1.0);
	clip_range(MAX_DEPTH * a.w - a.z, MAX_DEPTH * b.w - b.z, edge_range);
	for (int axis = 0; axis < 2; ++axis) {
		clip_range(VIEW_CLIP_LIMIT * a.w - a[axis], VIEW_CLIP_LIMIT * b.w - b[axis], edge_range);
		clip_range(VIEW_CLIP_LIMIT * a.w + a[axis], VIEW_CLIP_LIMIT * b.w + b[axis], edge_range);
	}
	if (edge_range.x > edge_range.y) {
		gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
		return;
	}
	const vec4 begin = mix(a, b, edge_range.x);
	const vec4 end = mix(a, b, edge_range.y);
	// Of two triangles. Bit 0: at the edge's end; bit 1: on its other side.
	const uint corner = uint[6](0u, 1u, 2u, 2u, 1u, 3u)[index % 6u];
	const bool is_at_end = (corner & 1u) != 0u;
	float depth = 0.0;
	if (edge.opposite1 != TOPOLOGY_NO_VERTEX) {
		const uint opposite1 = get_second_opposite(edge);
		if (!is_edge_record_silhouette(push.light_position_node, edge, a_node, b_node,
					positions_node[edge.opposite0].xyz, positions_node[opposite1].xyz)) {
			const vec4 c = project(edge.opposite0);
			const vec4 d = project(opposite1);
			const float change = max(compute_depth_change(a, b, c), compute_depth_change(b, a, d));
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
