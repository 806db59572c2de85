#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/work_rows_inc.glsl"
#include "shared/frame_shared.h"
#include "shared/lit_tiles_shared.h"

// The range of depths (near / z) of the surfaces in each tile of pixels; (1, 0) if there is none. One invocation per tile.
layout(local_size_x = LIT_TILES_GROUP_SIZE) in;
layout(std140, set = 0, binding = LIT_TILES_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(set = 0, binding = LIT_TILES_BINDING_DEPTH) uniform texture2D depth_texture;
layout(std430, set = 0, binding = LIT_TILES_BINDING_TILE_DEPTHS) restrict writeonly buffer TileDepths {
	vec2 tile_depths[];
};

void main() {
	const uvec2 size_px = frame.size_px;
	const uvec2 tiles = (size_px + uint(LIT_TILE_PX) - 1u) / uint(LIT_TILE_PX);
	const uint tile = find_work_item(uint(LIT_TILES_GROUP_SIZE));
	if (tile >= tiles.x * tiles.y) {
		return;
	}
	const ivec2 first = ivec2(uvec2(tile % tiles.x, tile / tiles.x) * uint(LIT_TILE_PX));
	const ivec2 last = ivec2(size_px) - 1;
	vec2 range = vec2(1.0, 0.0);
	for (int y = 0; y < LIT_TILE_PX; ++y) {
		for (int x = 0; x < LIT_TILE_PX; ++x) {
			const float depth = texelFetch(depth_texture, min(first + ivec2(x, y), last), 0).r;
			range.x = depth > 0.0 ? min(range.x, depth) : range.x;
			range.y = max(range.y, depth);
		}
	}
	tile_depths[tile] = range;
}
