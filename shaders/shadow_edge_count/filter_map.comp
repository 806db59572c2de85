#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_edge_count/shadow_edge_count_shared.h"
#include "shared/light_shared.h"

// The nearest caster of each texel of the layer map, as a depth map: for the blocks that have too many
// edges to count.
layout(local_size_x = MAP_RESOLVE_GROUP_SIZE, local_size_y = MAP_RESOLVE_GROUP_SIZE) in;
layout(set = 0, binding = MAP_RESOLVE_BINDING_VIEWS) uniform Views {
	LightViewsConstants light_views;
};
layout(set = 0, binding = COUNT_BINDING_TEXELS) uniform utextureBuffer texels_buffer;
layout(set = 0, binding = COUNT_BINDING_FRAGMENTS) uniform utextureBuffer fragments_buffer;
layout(set = 0, binding = COUNT_BINDING_OUTPUT, r32f) uniform writeonly image2DArray map_image;

void main() {
	const uvec3 place = gl_GlobalInvocationID;
	const LightViewConstants view = light_views.views[place.z];
	if (any(greaterThanEqual(place.xy, view.size_px))) {
		return;
	}
	const uvec2 range = texelFetch(texels_buffer,
			int((place.z * view.size_px.y + place.y) * view.size_px.x + place.x)).rg;
	const uint end = range.x + (range.y & LAYERS_COUNT_MASK);
	float w = 0.0;
	for (uint i = range.x; i < end; ++i) {
		w = max(w, uintBitsToFloat(texelFetch(fragments_buffer, int(i)).r & ~LAYERS_KIND_MASK));
	}
	imageStore(map_image, ivec3(place), vec4(clamp(w * view.depth_scale, 0.0, 1.0)));
}
