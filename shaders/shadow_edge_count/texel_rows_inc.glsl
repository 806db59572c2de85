// The texels of a view's map that a face may cover. The test is conservative, so that no receiver misses a face between
// itself and the light's centre.
#ifndef TEXEL_ROWS_INC_GLSL
#define TEXEL_ROWS_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

/// The rows of texels that a face may cover, and the data from which find_columns computes the columns of each row.
struct TexelRows {
	int first_row;
	int last_row; // below first_row if the face covers nothing
	int first_column;
	int last_column;
	// The face's sides as lines in the map's plane: dot(side, (x', y', 1)) >= 0 inside.
	vec3 sides[3];
	vec2 half_extent; // of the map, see CountViewConstants
	vec2 size;		  // of the map in texels
	// Bounds of the face in texels.
	vec2 minimum;
	vec2 maximum;
};

const float COUNT_ROUNDING_PX = 1e-3; // exceeds the rounding error of a receiver's position in texels

/// The line through two homogeneous points. p_orientation (1 or -1) orients it to be positive inside the face. It is
/// moved outwards by more than its rounding error.
vec3 make_texel_side(vec3 p_from, vec3 p_to, float p_orientation, vec2 p_half_extent) {
	const float ROUNDING = 1e-6;
	const vec3 side = p_orientation * cross(p_from, p_to);
	const float size = length(p_from) * length(p_to) * (1.0 + p_half_extent.x + p_half_extent.y);
	return side + vec3(0.0, 0.0, ROUNDING * size);
}

/// Homogeneous map coordinates of a point in light space: (x', y') is xy / z. The point is in front of the light if
/// z > 0.
vec3 find_homogeneous(CountLightConstants p_light, CountViewConstants p_view, vec3 p_point) {
	const vec2 across = vec2(dot(p_view.axis_x.xyz, p_point), dot(p_view.axis_y.xyz, p_point));
	return vec3(across, IS_DIRECTIONAL ? 1.0 : dot(p_view.axis_z.xyz, p_point));
}

/// The rows of texels that the face p_a, p_b, p_c may cover. p_level: how often the map's size is halved.
TexelRows make_texel_rows(CountLightConstants p_light, CountViewConstants p_view, uint p_level, vec3 p_a,
		vec3 p_b, vec3 p_c) {
	// As a fraction of a vertex's distance from the light. With a vertex of smaller depth, the bounds in texels are
	// useless.
	const float MIN_DEPTH_RATIO = 1e-6;
	const vec3 a = find_homogeneous(p_light, p_view, p_a);
	const vec3 b = find_homogeneous(p_light, p_view, p_b);
	const vec3 c = find_homogeneous(p_light, p_view, p_c);
	TexelRows rows;
	rows.half_extent = p_view.half_extent;
	rows.size = vec2(max(p_view.map_size_px >> p_level, uvec2(1u)));
	const float orientation = dot(a, cross(b, c)) >= 0.0 ? 1.0 : -1.0;
	rows.sides[0] = make_texel_side(a, b, orientation, p_view.half_extent);
	rows.sides[1] = make_texel_side(b, c, orientation, p_view.half_extent);
	rows.sides[2] = make_texel_side(c, a, orientation, p_view.half_extent);
	const vec3 min_z = MIN_DEPTH_RATIO * vec3(length(a), length(b), length(c));
	const bool is_in_front = all(greaterThan(vec3(a.z, b.z, c.z), min_z));
	// Bounds in texels.
	const vec2 point_a = a.xy / a.z;
	const vec2 point_b = b.xy / b.z;
	const vec2 point_c = c.xy / c.z;
	vec2 minimum = (min(point_a, min(point_b, point_c)) / p_view.half_extent * 0.5 + 0.5) * rows.size;
	vec2 maximum = (max(point_a, max(point_b, point_c)) / p_view.half_extent * 0.5 + 0.5) * rows.size;
	minimum = is_in_front ? minimum - COUNT_ROUNDING_PX : vec2(0.0);
	maximum = is_in_front ? maximum + COUNT_ROUNDING_PX : rows.size;
	// Entirely outside one of the map's sides, or behind the light: the face covers nothing.
	const vec2 bound = 1.001 * p_view.half_extent; // widened for rounding
	const vec2 max_low = max(a.xy + bound * a.z, max(b.xy + bound * b.z, c.xy + bound * c.z));
	const vec2 min_high = min(a.xy - bound * a.z, min(b.xy - bound * b.z, c.xy - bound * c.z));
	const bool is_outside = any(lessThan(max_low, vec2(0.0))) || any(greaterThan(min_high, vec2(0.0))) ||
			max(a.z, max(b.z, c.z)) <= 0.0;
	rows.minimum = minimum;
	rows.maximum = maximum;
	const ivec2 first = ivec2(clamp(floor(minimum), vec2(0.0), rows.size));
	const ivec2 last = ivec2(clamp(floor(maximum), vec2(-1.0), rows.size - 1.0));
	rows.first_column = first.x;
	rows.last_column = last.x;
	rows.first_row = first.y;
	rows.last_row = is_outside ? first.y - 1 : last.y;
	return rows;
}

/// Bit mask of the columns or rows of a texel's cells that the range p_minimum .. p_maximum overlaps, in texels.
/// p_texel: the texel's column or row.
uint find_cells(float p_minimum, float p_maximum, int p_texel) {
	const float side = float(EDGE_COUNT_NODE_CELLS_PER_SIDE);
	const uint all = (1u << EDGE_COUNT_NODE_CELLS_PER_SIDE) - 1u;
	const vec2 cells = clamp(side * (vec2(p_minimum, p_maximum) - float(p_texel)), 0.0, side - 1.0);
	return all << uint(cells.x) & all >> (uint(EDGE_COUNT_NODE_CELLS_PER_SIDE) - 1u - uint(cells.y));
}

/// First and last column of a row; the last is below the first if the face covers nothing there.
ivec2 find_columns(TexelRows p_rows, int p_row) {
	const vec2 y = (vec2(float(p_row), float(p_row + 1)) / p_rows.size.y * 2.0 - 1.0) * p_rows.half_extent.y;
	const float FAR = 3e38;
	float minimum = -FAR;
	float maximum = FAR;
	bool is_empty = false;
	for (int i = 0; i < 3; ++i) {
		const vec3 side = p_rows.sides[i];
		// The upper bound of the side's function in the row is side.x * x' + bound.
		const float bound = side.z + max(side.y * y.x, side.y * y.y);
		const float zero_x = -bound / side.x; // the x' where it is 0
		minimum = side.x > 0.0 ? max(minimum, zero_x) : minimum;
		maximum = side.x < 0.0 ? min(maximum, zero_x) : maximum;
		is_empty = is_empty || (side.x == 0.0 && bound < 0.0);
	}
	const float first = (minimum / p_rows.half_extent.x * 0.5 + 0.5) * p_rows.size.x - COUNT_ROUNDING_PX;
	const float last = (maximum / p_rows.half_extent.x * 0.5 + 0.5) * p_rows.size.x + COUNT_ROUNDING_PX;
	return ivec2(max(p_rows.first_column, int(clamp(floor(first), 0.0, p_rows.size.x))),
			is_empty ? -1 : min(p_rows.last_column, int(clamp(floor(last), -1.0, p_rows.size.x - 1.0))));
}

#endif
