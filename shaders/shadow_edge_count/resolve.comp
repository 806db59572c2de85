#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_vote : require
#include "shadow_edge_count/count_resolve_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_OUTPUT, r16f) uniform writeonly image2D mask_image;

void main() {
	const CountPixel pixel = count_pixel();
	if (is_in_picture(pixel.pixel)) {
		imageStore(mask_image, pixel.pixel, vec4(pixel.visibility));
	}
}
