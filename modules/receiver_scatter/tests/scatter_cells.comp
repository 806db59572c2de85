#version 460
#extension GL_GOOGLE_include_directive : require
#include "receiver_scatter/cells_inc.glsl"

// Runs cells_inc.glsl: computes a random point of each cell of the disc, the point's weight, and the disc's
// number of rings.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 cells[]; // s, ring, sector, number of sectors
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[]; // x, y: point in pixels from the disc's centre; z: weight; w: number of rings
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (item >= uint(cells.length())) {
		return;
	}
	const vec4 cell = cells[item];
	const uint ring_count = count_rings(cell.x);
	uint random = hash_pixel(uvec2(item, 7u)); // a fixed seed per item
	const float across = next_random(random);
	const float along = next_random(random);
	const float radius_px = SCATTER_RADIUS_PX * cell.x;
	const vec2 point = find_cell_point(
			uvec2(cell.yz), uvec2(ring_count, uint(cell.w)), radius_px, vec2(across, along));
	results[item] = vec4(point, find_disc_weight(length(point), radius_px), float(ring_count));
}
