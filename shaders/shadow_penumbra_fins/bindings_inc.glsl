// What resolve.comp, cases.comp and hard.comp read: the frame and the receivers.
#ifndef BINDINGS_INC_GLSL
#define BINDINGS_INC_GLSL

#include "common/map_compare_inc.glsl"
#include "common/receiver_inc.glsl"
#include "shadow_penumbra_fins/shadow_penumbra_fins_shared.h"

layout(local_size_x = FINS_GROUP_SIZE, local_size_y = FINS_GROUP_SIZE) in;
layout(set = 0, binding = RESOLVE_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(set = 0, binding = RESOLVE_BINDING_VIEWS) uniform Views {
	LightViewsConstants light_views;
};
layout(set = 0, binding = RESOLVE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = RESOLVE_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = RESOLVE_BINDING_RECEIVERS) uniform texture2D receivers_texture;
layout(set = 0, binding = RESOLVE_BINDING_LAYER_1) uniform texture2DArray layer_1_texture;
layout(push_constant) uniform Push {
	FinsResolvePush push;
};

bool is_in_picture(ivec2 p_pixel) {
	return all(lessThan(p_pixel, ivec2(frame.size_px)));
}

bool is_receiver_pixel(ivec2 p_pixel) {
	return texelFetch(receivers_texture, p_pixel, 0).r > 0.0;
}

/// The receiver of a pixel as the view that holds it sees it. r_view: that view.
MapPoint load_map_point(ivec2 p_pixel, out uint r_view) {
	const vec3 normal = unpack_normal(texelFetch(normal_texture, p_pixel, 0).r);
	const vec3 position = receiver_position(
			frame, p_pixel, texelFetch(depth_texture, p_pixel, 0).r, normal);
	r_view = find_view(light_views, position);
	return project_to_map(light_views.views[r_view], position, normal);
}

/// True when nothing can hide the receiver: its view has no casters, or it lies behind the view.
bool is_surely_lit(MapPoint p_point, uint p_view) {
	return (push.empty_views & (1u << p_view)) != 0u || p_point.w <= 0.0;
}

#endif
