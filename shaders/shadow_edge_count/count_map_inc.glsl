// The layer map in texel buffers.
#ifndef COUNT_MAP_INC_GLSL
#define COUNT_MAP_INC_GLSL

#include "shadow_edge_count/count_layers_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_TEXELS) uniform utextureBuffer texels_buffer;
layout(set = 0, binding = COUNT_BINDING_FRAGMENTS) uniform utextureBuffer fragments_buffer;

uvec2 load_count_texel(uint p_index) {
	return texelFetch(texels_buffer, int(p_index)).rg;
}

vec2 load_count_fragment(uint p_index) {
	const uint bits = texelFetch(fragments_buffer, int(p_index)).r;
	return vec2(uintBitsToFloat(bits & ~LAYERS_KIND_MASK), float(bits & LAYERS_KIND_MASK));
}

#endif
