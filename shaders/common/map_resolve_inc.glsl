// The receiver of each pixel as a light view sees it: what a compute shader needs that looks
// receivers up in maps drawn from the light. It reads make_map_resolve_bindings of the renderer.
#ifndef MAP_RESOLVE_INC_GLSL
#define MAP_RESOLVE_INC_GLSL

#include "common/light_view_inc.glsl"
#include "common/receiver_inc.glsl"
#include "shared/map_resolve_shared.h"

layout(local_size_x = MAP_RESOLVE_GROUP_SIZE, local_size_y = MAP_RESOLVE_GROUP_SIZE) in;
layout(set = 0, binding = MAP_RESOLVE_BINDING_FRAME) uniform Frame {
	FrameConstants frame;
};
layout(set = 0, binding = MAP_RESOLVE_BINDING_VIEWS) uniform Views {
	LightViewsConstants light_views;
};
layout(set = 0, binding = MAP_RESOLVE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = MAP_RESOLVE_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = MAP_RESOLVE_BINDING_RECEIVERS) uniform texture2D receivers_texture;

/// The pixel of this invocation. Rows of work groups are dealt out in two hands, even ones first:
/// drivers that give each core one half of a dispatch then give it every other row, and no core waits
/// where one half of the picture costs more. pcss with 64 taps at 512 x 512, 2 cores: terrain 246 ms
/// so and 298 without, contact_box 172 and 202.
ivec2 find_pixel() {
	const uint even_count = (gl_NumWorkGroups.y + 1u) / 2u;
	const uint group = gl_WorkGroupID.y;
	const uint row = group < even_count ? 2u * group : 2u * (group - even_count) + 1u;
	return ivec2(gl_GlobalInvocationID.x, row * gl_WorkGroupSize.y + gl_LocalInvocationID.y);
}

bool is_in_picture(ivec2 p_pixel) {
	return all(lessThan(p_pixel, ivec2(frame.size_px)));
}

/// The mask counts only there.
bool is_receiver_pixel(ivec2 p_pixel) {
	return texelFetch(receivers_texture, p_pixel, 0).r > 0.0;
}

/// The receiver of a pixel in the map of the view that holds it. r_view: that view's index. Only for
/// pixels that receive.
MapPoint load_map_point(ivec2 p_pixel, out uint r_view) {
	const vec3 normal = unpack_normal(texelFetch(normal_texture, p_pixel, 0).r);
	const vec3 position = receiver_position(
			frame, p_pixel, texelFetch(depth_texture, p_pixel, 0).r, normal);
	r_view = find_view(light_views, position);
	return project_to_map(light_views.views[r_view], position, normal);
}

/// True when nothing can hide the receiver: it lies behind its view, or the view has no casters.
/// p_empty_views: bit i for a view i without casters.
bool is_surely_lit(MapPoint p_point, uint p_view, uint p_empty_views) {
	return (p_empty_views & (1u << p_view)) != 0u || p_point.w <= 0.0;
}

#endif
