#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"
#include "common/work_rows_inc.glsl"
#include "shared/light_shared.h"
#include "shared/lit_tiles_shared.h"

// Lists the tiles that may contain a receiver of the light, by bounds of the surfaces in each tile. One invocation per tile.
layout(local_size_x = LIT_TILES_GROUP_SIZE) in;
layout(std140, set = 0, binding = LIT_TILES_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(std140, set = 0, binding = LIT_TILES_BINDING_LIGHT) restrict readonly buffer Light {
	LightConstants light;
};
layout(std430, set = 0, binding = LIT_TILES_BINDING_TILE_DEPTHS) restrict readonly buffer TileDepths {
	vec2 tile_depths[];
};
layout(std430, set = 0, binding = LIT_TILES_BINDING_TILES) restrict buffer Tiles {
	uint tiles[]; // cleared before
};
layout(std430, set = 0, binding = LIT_TILES_BINDING_ARGUMENTS) restrict buffer Arguments {
	uint arguments[]; // cleared before
};
layout(push_constant) uniform Push {
	LitTilesPush push;
};

/// False only if no point of a box can be inside the light's range and cone, see is_receiver.
bool may_reach(vec3 p_minimum, vec3 p_maximum) {
	if (light.type == LIGHT_TYPE_DIRECTIONAL) {
		return true;
	}
	const float WIDENING = 1e-4; // for rounding, relative to the distance from the camera
	const vec3 center = 0.5 * (p_minimum + p_maximum);
	const float margin = WIDENING * max(length(p_minimum), length(p_maximum));
	const vec3 half_size = 0.5 * (p_maximum - p_minimum) + margin;
	const vec3 from_light = center - light.position_radius.xyz;
	const vec3 gap = max(abs(from_light) - half_size, vec3(0.0));
	const bool is_in_range = !(light.range_m > 0.0) || !(length(gap) > light.range_m);
	// The distance of the box's bounding sphere from the cone; from the plane across its axis if the cone is so wide.
	const float along = dot(from_light, light.direction.xyz);
	const float across = sqrt(max(dot(from_light, from_light) - along * along, 0.0));
	const float sine = sqrt(max(1.0 - light.cos_outer * light.cos_outer, 0.0));
	const float distance_m = across * light.cos_outer - along * sine;
	const bool is_in_cone = light.type != LIGHT_TYPE_SPOT || light.cos_outer < 0.0 || !(distance_m > length(half_size));
	return is_in_range && is_in_cone;
}

void main() {
	const uvec2 tile_count = (frame.size_px + uint(LIT_TILE_PX) - 1u) / uint(LIT_TILE_PX);
	const uint tile = find_work_item(uint(LIT_TILES_GROUP_SIZE));
	if (tile == 0u) {
		arguments[LIT_TILES_BLOCK_ARGUMENTS] = uint(LIT_TILES_PER_ROW * LIT_TILE_BLOCKS);
		arguments[LIT_TILES_BLOCK_ARGUMENTS + 2] = 1u;
		arguments[LIT_TILES_TILE_ARGUMENTS] = uint(LIT_TILES_PER_ROW);
		arguments[LIT_TILES_TILE_ARGUMENTS + 2] = 1u;
	}
	if (tile >= tile_count.x * tile_count.y) {
		return;
	}
	const vec2 depths = tile_depths[tile];
	const vec2 first_px = vec2(uvec2(tile % tile_count.x, tile / tile_count.x) * uint(LIT_TILE_PX));
	vec3 minimum = vec3(3e38);
	vec3 maximum = vec3(-3e38);
	for (int i = 0; i < 8; ++i) {
		const vec2 corner_px = first_px + float(LIT_TILE_PX) * vec2(i & 1, i >> 1 & 1);
		const vec3 corner = position_at(frame, corner_px, (i & 4) != 0 ? depths.y : depths.x);
		minimum = min(minimum, corner);
		maximum = max(maximum, corner);
	}
	const bool has_surface = depths.y > 0.0;
	if (push.lists_all != 0u || (has_surface && may_reach(minimum, maximum))) {
		const uint slot = atomicAdd(tiles[LIT_TILES_COUNT], 1u);
		tiles[uint(LIT_TILES_FIRST) + slot] = tile;
		const uint row_count = slot / uint(LIT_TILES_PER_ROW) + 1u;
		atomicMax(arguments[LIT_TILES_BLOCK_ARGUMENTS + 1], row_count);
		atomicMax(arguments[LIT_TILES_TILE_ARGUMENTS + 1], row_count);
	}
}
