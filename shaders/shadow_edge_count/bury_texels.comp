#version 460
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/count_space_inc.glsl"

// Marks the texels that a silhouette from the light's centre passes nearer than the rasteriser's rounding
// of vertices: what such a texel holds may belong to either side. One invocation per edge of a view.
layout(local_size_x = 64) in;
layout(set = 0, binding = LAYERS_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = LAYERS_BINDING_TEXELS) buffer Texels {
	uvec2 texels[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_TOTALS) readonly buffer Totals {
	uint totals[];
};
layout(std430, set = 0, binding = LAYERS_BINDING_RECORDS) readonly buffer Records {
	CountEdgeRecord records[];
};
layout(push_constant) uniform Push {
	CountPartPush push;
};

const float BURIED_PX = 1.0 / 128.0; // twice the rasteriser's 8 bits of a texel

vec2 to_texels(vec2 p_point) {
	return (p_point / view.half_extent * 0.5 + 0.5) * vec2(view.map_size_px);
}

/// Part of the line from p_from along p_way, 0..1, where one coordinate lies between two bounds.
vec2 cut_to_bounds(vec2 p_part, float p_from, float p_way, float p_least, float p_greatest) {
	if (p_way == 0.0) {
		return p_from >= p_least && p_from <= p_greatest ? p_part : vec2(1.0, 0.0);
	}
	const float t0 = (p_least - p_from) / p_way;
	const float t1 = (p_greatest - p_from) / p_way;
	return vec2(max(p_part.x, min(t0, t1)), min(p_part.y, max(t0, t1)));
}

void main() {
	const uint total = min(totals[uint(EDGE_COUNT_TOTAL_RECORDS) + view.index], push.record_capacity);
	const uint edge = gl_GlobalInvocationID.x;
	if (edge >= total) {
		return;
	}
	const CountEdgeRecord record = records[view.index * push.record_capacity + edge];
	if (record.by_bw_weight_kind.z == 0.0) {
		return;
	}
	vec2 from = to_texels(record.a_bx.xy);
	vec2 way = to_texels(vec2(record.a_bx.w, record.by_bw_weight_kind.x)) - from;
	// Only what lies over the map; from then on in steps along the longer side, one row or column each.
	const vec2 size_px = vec2(view.map_size_px);
	vec2 part = cut_to_bounds(vec2(0.0, 1.0), from.x, way.x, -1.0, size_px.x + 1.0);
	part = cut_to_bounds(part, from.y, way.y, -1.0, size_px.y + 1.0);
	if (part.x > part.y) {
		return;
	}
	const bool is_steep = abs(way.y) > abs(way.x);
	from = is_steep ? from.yx : from;
	way = is_steep ? way.yx : way;
	const float length_way = length(way);
	const vec2 u = length_way > 0.0 ? way / length_way : vec2(0.0);
	const float end0 = from.x + part.x * way.x;
	const float end1 = from.x + part.y * way.x;
	const int first = int(floor(min(end0, end1) - 0.5 - BURIED_PX)) ;
	const int last = int(ceil(max(end0, end1) - 0.5 + BURIED_PX));
	for (int column = first; column <= last; ++column) {
		const float center = float(column) + 0.5;
		const float share = way.x != 0.0 ? clamp((center - from.x) / way.x, 0.0, 1.0) : 0.0;
		const float row = floor(from.y + share * way.y);
		for (float r = row - 1.0; r <= row + 1.0; r += 1.0) {
			const vec2 offset = vec2(center, r + 0.5) - from;
			const float along = clamp(dot(offset, u), 0.0, length_way);
			const ivec2 texel = is_steep ? ivec2(int(r), column) : ivec2(column, int(r));
			if (length(offset - along * u) <= BURIED_PX && all(greaterThanEqual(texel, ivec2(0))) &&
					all(lessThan(texel, ivec2(view.map_size_px)))) {
				atomicOr(texels[(view.index * view.map_size_px.y + uint(texel.y)) *
										view.map_size_px.x + uint(texel.x)].y,
						LAYERS_BURIED);
			}
		}
	}
}
