// The receiver of a pixel, in light space and in the light view that contains it.
#ifndef COUNT_PIXELS_INC_GLSL
#define COUNT_PIXELS_INC_GLSL

#include "common/receiver_pixels_inc.glsl"
#include "shadow_edge_count/count_constants_inc.glsl"
#include "shadow_edge_count/count_space_inc.glsl"

// Copies of constants, for speed: see count_constants_inc.glsl.
FrameConstants frame_copy;
mat4 light_from_camera;
mat4 axes_from_camera; // to the light's own axes, see find_view

void load_count_constants() {
	load_light();
	frame_copy = frame;
	light_from_camera = light_views.views[0].view_from_camera_relative;
	axes_from_camera = light_views.light_from_camera_relative;
}

/// The position in the 8 x 8 block of the pixel with this index, 0..63. The order is Morton's, so that pixels with
/// consecutive indices are close together.
uvec2 find_pixel_in_block(uint p_index) {
	const uint x = (p_index & 1u) | ((p_index >> 1) & 2u) | ((p_index >> 2) & 4u);
	const uint y = ((p_index >> 1) & 1u) | ((p_index >> 2) & 2u) | ((p_index >> 3) & 4u);
	return uvec2(x, y);
}

/// A pixel's receiver.
struct CountPoint {
	vec3 position; // light space
	uint view;	   // light view that contains it
	vec3 warped;   // x', y' and w in the view
	float offset_fraction; // how far it was moved off its surface, as a fraction of the maximum
};

/// The pixel must have a receiver, see is_receiver_pixel.
CountPoint load_count_point(ivec2 p_pixel) {
	const ReceiverPixel pixel = load_receiver(frame_copy, p_pixel);
	CountPoint point;
	point.view = VIEW_COUNT == 1u ? 0u : find_view_of_direction((axes_from_camera * vec4(pixel.position, 1.0)).xyz);
	point.offset_fraction = pixel.offset_m / frame_copy.max_receiver_offset_m;
	point.position = (light_from_camera * vec4(pixel.position, 1.0)).xyz;
	const CountViewConstants view = load_count_view(point.view);
	const mat3 light_from_view = mat3(view.axis_x.xyz, view.axis_y.xyz, view.axis_z.xyz);
	// In the view's axes: a product with the matrix on the right applies its transpose.
	const vec3 r = VIEW_COUNT == 1u ? point.position : point.position * light_from_view;
	point.warped = IS_DIRECTIONAL ? vec3(r.xy, light.depth_far_m - r.z) : vec3(r.xy, 1.0) / r.z;
	return point;
}

/// False if no caster of the view can hide the receiver: the receiver is behind the light, or the view is one of
/// CountLightConstants::empty_views.
bool may_count_at(CountPoint p_point) {
	const bool is_in_front = IS_DIRECTIONAL || p_point.warped.z > 0.0;
	return (light.empty_views & (1u << p_point.view)) == 0u && is_in_front;
}

#endif
