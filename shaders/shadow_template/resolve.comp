#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/map_compare_inc.glsl"
#include "common/receiver_inc.glsl"
#include "shadow_template/shadow_template_shared.h"

// One comparison with one texel of the light's depth: replace it by your own idea.
layout(local_size_x = SHADOW_TEMPLATE_GROUP_SIZE, local_size_y = SHADOW_TEMPLATE_GROUP_SIZE) in;
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_VIEWS) uniform Views {
	LightViewsConstants light_views;
};
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_MAP) uniform texture2DArray map_texture;
layout(set = 0, binding = SHADOW_TEMPLATE_BINDING_MASK, r16f) uniform writeonly image2D mask_image;
layout(push_constant) uniform Push {
	ShadowTemplatePush push;
};

float find_visibility(ivec2 p_pixel) {
	if (texelFetch(receivers_texture, p_pixel, 0).r == 0.0) {
		return 0.0;
	}
	const vec3 normal = unpack_normal(texelFetch(normal_texture, p_pixel, 0).r);
	const vec3 position = receiver_position(
			frame, p_pixel, texelFetch(depth_texture, p_pixel, 0).r, normal);
	const LightViewConstants view = light_views.views[find_view(light_views, position)];
	const MapPoint point = project_to_map(view, position, normal);
	const ivec2 texel = ivec2(floor(texels_from_map(view, point.xy)));
	if (point.w <= 0.0 || any(lessThan(texel, ivec2(0))) ||
			any(greaterThanEqual(texel, ivec2(view.size_px)))) {
		return 1.0;
	}
	const float stored = texelFetch(map_texture, ivec3(texel, view.layer), 0).r;
	return mix(1.0, compare_texel(view, point, texel, stored), push.strength);
}

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (all(lessThan(pixel, ivec2(frame.size_px)))) {
		imageStore(mask_image, pixel, vec4(find_visibility(pixel)));
	}
}
