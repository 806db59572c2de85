// The receiver of each pixel as a light view sees it: what a compute shader needs that looks
// receivers up in maps drawn from the light. It reads make_map_resolve_bindings of shadows.
#ifndef MAP_RESOLVE_INC_GLSL
#define MAP_RESOLVE_INC_GLSL

#include "common/receiver_pixels_inc.glsl"
#include "common/work_rows_inc.glsl"

layout(local_size_x = MAP_RESOLVE_GROUP_SIZE, local_size_y = MAP_RESOLVE_GROUP_SIZE) in;

/// The group of pixels of this work group.
uvec2 find_group() {
	return uvec2(gl_WorkGroupID.x, find_work_row());
}

/// The pixel of this invocation.
ivec2 find_pixel() {
	return ivec2(find_group() * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy);
}

/// The receiver of a pixel in the map of the view that holds it. r_view: that view's index. Only for
/// pixels that receive.
MapPoint load_map_point(ivec2 p_pixel, out uint r_view) {
	const ReceiverPixel receiver = load_receiver(p_pixel);
	r_view = find_view(light_views, receiver.position);
	return project_to_map(light_views.views[r_view], receiver.position, receiver.normal);
}

/// True when nothing can hide the receiver: it is behind its view, or the view has no casters.
/// p_empty_views: bit i for a view i without casters.
bool is_surely_lit(MapPoint p_point, uint p_view, uint p_empty_views) {
	return (p_empty_views & (1u << p_view)) != 0u || p_point.w <= 0.0;
}

#endif
