#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_volume/bounds_inc.glsl"

// Builds one level of the occluders' depth pyramid: each texel is the minimum (reversed depth: the farthest) of 4 x 4
// texels of the level before. Level 1 also copies level 0 from the occluder map.
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = CULLING_BINDING_DEPTH) uniform texture2D depth_map;
layout(std430, set = 0, binding = CULLING_BINDING_BOUNDS) buffer Bounds {
	float bounds[];
};
layout(push_constant) uniform Push {
	BoundsPush push;
};

void main() {
	const uvec2 texel = gl_GlobalInvocationID.xy;
	if (any(greaterThanEqual(texel, uvec2(bounds_size_px(push.level))))) {
		return;
	}
	float min_depth = 1.0;
	for (uint i = 0u; i < CULLING_LEVEL_FACTOR * CULLING_LEVEL_FACTOR; ++i) {
		const uvec2 source = texel * CULLING_LEVEL_FACTOR + uvec2(i % CULLING_LEVEL_FACTOR, i / CULLING_LEVEL_FACTOR);
		const uint index = bounds_index(push.view_index, push.level - 1u, source);
		if (push.level == 1u) {
			bounds[index] = texelFetch(depth_map, ivec2(source), 0).x;
		}
		min_depth = min(min_depth, bounds[index]);
	}
	bounds[bounds_index(push.view_index, push.level, texel)] = min_depth;
}
