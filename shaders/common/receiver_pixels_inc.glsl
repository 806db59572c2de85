// Loads the receivers of pixels, and the views of one light. Uses the bindings that
// make_map_resolve_bindings of modules/shadows/mask.h sets.
#ifndef RECEIVER_PIXELS_INC_GLSL
#define RECEIVER_PIXELS_INC_GLSL

#include "common/depth_inc.glsl"
#include "common/light_view_inc.glsl"
#include "common/normal_inc.glsl"
#include "shared/map_resolve_shared.h"

layout(std140, set = 0, binding = MAP_RESOLVE_BINDING_FRAME) restrict readonly buffer Frame {
	FrameConstants frame;
};
layout(std140, set = 0, binding = MAP_RESOLVE_BINDING_VIEWS) restrict readonly buffer Views {
	LightViewsConstants light_views;
};
layout(set = 0, binding = MAP_RESOLVE_BINDING_DEPTH) uniform texture2D depth_texture;
layout(set = 0, binding = MAP_RESOLVE_BINDING_NORMAL) uniform utexture2D normal_texture;
layout(set = 0, binding = MAP_RESOLVE_BINDING_RECEIVERS) uniform texture2D receivers_texture;

bool is_in_image(ivec2 p_pixel) {
	return all(lessThan(p_pixel, ivec2(frame.size_px)));
}

/// True when the light can reach the pixel's surface. The mask of other pixels is not used.
bool is_receiver_pixel(ivec2 p_pixel) {
	return texelFetch(receivers_texture, p_pixel, 0).r > 0.0;
}

struct ReceiverPixel {
	vec3 position;	// camera-relative, moved off the surface
	vec3 normal;	// unit, of the face, towards the viewer; away from it if it is a receiver on its far side
	float offset_m; // how far it was moved
};

/// Loads a pixel's receiver. Call it only where is_receiver_pixel is true. p_frame: `frame`, or a
/// copy of it.
ReceiverPixel load_receiver(FrameConstants p_frame, ivec2 p_pixel) {
	const bool is_far = is_on_far_side(texelFetch(receivers_texture, p_pixel, 0).r);
	const vec3 normal = (is_far ? -1.0 : 1.0) * unpack_normal(texelFetch(normal_texture, p_pixel, 0).r);
	const float depth = texelFetch(depth_texture, p_pixel, 0).r;
	const float offset_m = compute_receiver_offset_m(p_frame, distance_from_depth(p_frame, depth));
	return ReceiverPixel(
			position_from_depth(p_frame, p_pixel, depth) + offset_m * normal, normal, offset_m);
}

ReceiverPixel load_receiver(ivec2 p_pixel) {
	return load_receiver(frame, p_pixel);
}

#endif
