// The texels of a view's map that a face may cover: conservative, so that no receiver misses a face between
// itself and the light's centre.
#ifndef TEXEL_ROWS_INC_GLSL
#define TEXEL_ROWS_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// The rows of texels that a face may cover, and what bounds its columns in each.
struct TexelRows {
	int first_row;
	int last_row; // before the first where the face covers nothing
	int first_column;
	int last_column;
	// Three sides as lines of the map's plane: dot(side, (x', y', 1)) is not below 0 inside.
	vec3 sides[3];
	vec2 half_extent;
	vec2 size; // of the map in texels
};

const float COUNT_ROUNDING_PX = 1e-3; // more than where a receiver's texel is rounded

/// A side through two points of the homogeneous plane, turned so that inside is not below 0, and moved
/// outwards by more than its rounding.
vec3 make_texel_side(vec3 p_from, vec3 p_to, float p_turn, vec2 p_half_extent) {
	const float ROUNDING = 1e-6;
	const vec3 side = p_turn * cross(p_from, p_to);
	const float size = length(p_from) * length(p_to) * (1.0 + p_half_extent.x + p_half_extent.y);
	return side + vec3(0.0, 0.0, ROUNDING * size);
}

/// A point of the homogeneous plane: (x', y') is xy over z, in front of the light where z is above 0.
vec3 find_homogeneous(CountLightConstants p_light, CountViewConstants p_view, vec3 p_point) {
	const vec2 across = vec2(dot(p_view.axis_x.xyz, p_point), dot(p_view.axis_y.xyz, p_point));
	return vec3(across, p_light.is_directional != 0u ? 1.0 : dot(p_view.axis_z.xyz, p_point));
}

/// p_level: the map's size is halved so often.
TexelRows make_texel_rows(CountLightConstants p_light, CountViewConstants p_view, uint p_level, vec3 p_a,
		vec3 p_b, vec3 p_c) {
	const float SMALLEST_DEPTH = 1e-6; // of a point's distance: nearer to the light's plane, bounds are useless
	const vec3 a = find_homogeneous(p_light, p_view, p_a);
	const vec3 b = find_homogeneous(p_light, p_view, p_b);
	const vec3 c = find_homogeneous(p_light, p_view, p_c);
	TexelRows rows;
	rows.half_extent = p_view.half_extent;
	rows.size = vec2(max(p_view.map_size_px >> p_level, uvec2(1u)));
	const float turn = dot(a, cross(b, c)) >= 0.0 ? 1.0 : -1.0;
	rows.sides[0] = make_texel_side(a, b, turn, p_view.half_extent);
	rows.sides[1] = make_texel_side(b, c, turn, p_view.half_extent);
	rows.sides[2] = make_texel_side(c, a, turn, p_view.half_extent);
	const vec3 least_z = SMALLEST_DEPTH * vec3(length(a), length(b), length(c));
	const bool is_before = all(greaterThan(vec3(a.z, b.z, c.z), least_z));
	// Bounds, in texels.
	const vec2 point_a = a.xy / a.z;
	const vec2 point_b = b.xy / b.z;
	const vec2 point_c = c.xy / c.z;
	vec2 least = (min(point_a, min(point_b, point_c)) / p_view.half_extent * 0.5 + 0.5) * rows.size;
	vec2 greatest = (max(point_a, max(point_b, point_c)) / p_view.half_extent * 0.5 + 0.5) * rows.size;
	least = is_before ? least - COUNT_ROUNDING_PX : vec2(0.0);
	greatest = is_before ? greatest + COUNT_ROUNDING_PX : rows.size;
	// Wholly beyond one of the map's sides, or behind the light: nothing.
	const vec2 most = 1.001 * p_view.half_extent;
	const vec2 most_low = max(a.xy + most * a.z, max(b.xy + most * b.z, c.xy + most * c.z));
	const vec2 least_high = min(a.xy - most * a.z, min(b.xy - most * b.z, c.xy - most * c.z));
	const bool is_aside = any(lessThan(most_low, vec2(0.0))) || any(greaterThan(least_high, vec2(0.0))) ||
			max(a.z, max(b.z, c.z)) <= 0.0;
	const ivec2 first = ivec2(clamp(floor(least), vec2(0.0), rows.size));
	const ivec2 last = ivec2(clamp(floor(greatest), vec2(-1.0), rows.size - 1.0));
	rows.first_column = first.x;
	rows.last_column = last.x;
	rows.first_row = first.y;
	rows.last_row = is_aside ? first.y - 1 : last.y;
	return rows;
}

/// First and last column of a row; the last before the first where there is none.
ivec2 find_columns(TexelRows p_rows, int p_row) {
	const vec2 y = (vec2(float(p_row), float(p_row + 1)) / p_rows.size.y * 2.0 - 1.0) * p_rows.half_extent.y;
	const float FAR = 3e38;
	float least = -FAR;
	float greatest = FAR;
	bool is_empty = false;
	for (int i = 0; i < 3; ++i) {
		const vec3 side = p_rows.sides[i];
		// The most that the side has anywhere in the row, as a function of x'.
		const float most = side.z + max(side.y * y.x, side.y * y.y);
		const float at = -most / side.x;
		least = side.x > 0.0 ? max(least, at) : least;
		greatest = side.x < 0.0 ? min(greatest, at) : greatest;
		is_empty = is_empty || (side.x == 0.0 && most < 0.0);
	}
	const float first = (least / p_rows.half_extent.x * 0.5 + 0.5) * p_rows.size.x - COUNT_ROUNDING_PX;
	const float last = (greatest / p_rows.half_extent.x * 0.5 + 0.5) * p_rows.size.x + COUNT_ROUNDING_PX;
	return ivec2(max(p_rows.first_column, int(clamp(floor(first), 0.0, p_rows.size.x))),
			is_empty ? -1 : min(p_rows.last_column, int(clamp(floor(last), -1.0, p_rows.size.x - 1.0))));
}

#endif
