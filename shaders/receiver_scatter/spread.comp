#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "receiver_scatter/dipole_inc.glsl"
#include "receiver_scatter/disc_inc.glsl"

// Computes the mask's mean around each translucent receiver.
layout(local_size_x = SCATTER_GROUP_SIZE, local_size_y = SCATTER_GROUP_SIZE) in;

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (!is_in_image(pixel)) {
		return;
	}
	vec4 mask = texelFetch(mask_texture, pixel, 0);
	Receiver receiver;
	if (load_receiver(pixel, receiver)) {
		mask.rgb = is_metric(receiver) ? spread_in_metres(pixel, receiver)
									   : spread_in_pixels(pixel, receiver);
	}
	imageStore(result_image, pixel, mask);
}
