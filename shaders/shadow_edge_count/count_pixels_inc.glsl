// The receiver of a pixel in the light view that holds it.
#ifndef COUNT_PIXELS_INC_GLSL
#define COUNT_PIXELS_INC_GLSL

#include "common/receiver_pixels_inc.glsl"
#include "shadow_edge_count/count_space_inc.glsl"

layout(set = 0, binding = COUNT_BINDING_LIGHT) uniform Light {
	CountLightConstants light;
};

layout(constant_id = EDGE_COUNT_CONSTANT_VIEW_COUNT) const uint VIEW_COUNT = 1u;

/// Only for pixels that receive.
CountReceiver load_count_receiver(ivec2 p_pixel, out uint r_view) {
	const ReceiverPixel pixel = load_receiver(p_pixel);
	r_view = VIEW_COUNT == 1u ? 0u : find_view(light_views, pixel.position);
	const mat4 view_from_camera_relative = light_views.views[r_view].view_from_camera_relative;
	return make_count_receiver(light.views[r_view],
			(view_from_camera_relative * vec4(pixel.position, 1.0)).xyz,
			mat3(view_from_camera_relative) * pixel.normal);
}

/// False where no caster of the view can hide the receiver: it lies behind the view, or the view has no
/// casters.
bool may_count_at(vec3 p_warped, uint p_view) {
	const bool is_before = light.views[p_view].is_directional != 0u || p_warped.z > 0.0;
	return (light.empty_views & (1u << p_view)) == 0u && is_before;
}

#endif
