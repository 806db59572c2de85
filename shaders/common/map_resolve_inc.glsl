// For compute shaders that look each pixel's receiver up in maps drawn from the light. Uses the bindings that
// make_map_resolve_bindings of modules/shadows/mask.h sets.
#ifndef MAP_RESOLVE_INC_GLSL
#define MAP_RESOLVE_INC_GLSL

#include "common/receiver_pixels_inc.glsl"
#define LIT_TILES_BINDING MAP_RESOLVE_BINDING_TILES
#include "common/lit_tiles_inc.glsl"

layout(local_size_x = MAP_RESOLVE_GROUP_SIZE, local_size_y = MAP_RESOLVE_GROUP_SIZE) in;

/// The pixel that this invocation processes; outside the image if there is none. For add_map_resolve_pass of
/// modules/shadows/mask.h, which dispatches the tiles that the light may reach.
ivec2 find_pixel() {
	return find_lit_pixel(frame.size_px);
}

/// Projects a pixel's receiver into the view that contains it. r_view: that view's index. Call it only for pixels for
/// which is_receiver_pixel is true.
MapPoint load_map_point(ivec2 p_pixel, out uint r_view) {
	const ReceiverPixel receiver = load_receiver(p_pixel);
	r_view = find_view(light_views, receiver.position);
	return project_to_map(light_views.views[r_view], receiver.position, receiver.normal);
}

/// True when the receiver counts as lit without a lookup, because it is behind the view or the view was not drawn.
/// p_empty_views: bit i is set when view i was not drawn, for lack of casters or receivers.
bool is_trivially_lit(MapPoint p_point, uint p_view, uint p_empty_views) {
	return (p_empty_views & (1u << p_view)) != 0u ||
			is_behind_view(light_views.views[p_view], p_point);
}

#endif
