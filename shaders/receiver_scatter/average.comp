#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "receiver_scatter/receiver_inc.glsl"

// Averages each pixel of spread.comp's mask with its neighbours, which took their samples from different sets. The
// window is one pixel wider and higher than a block, and its outermost pixels count by half. So it is centred on the
// pixel, and every set has the same weight.
layout(local_size_x = SCATTER_GROUP_SIZE, local_size_y = SCATTER_GROUP_SIZE) in;

// Minimum cosine between the normals of pixels that are averaged; 0 across the edge of a box.
const float MIN_COSINE = 0.7;

void main() {
	const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	if (!is_in_image(pixel)) {
		return;
	}
	vec4 mask = texelFetch(mask_texture, pixel, 0);
	Receiver receiver;
	int reach = 0;
	if (load_receiver(pixel, receiver) && is_metric(receiver)) {
		reach = find_block_width(receiver) / 2;
	}
	if (reach > 0) {
		vec3 sum = vec3(0.0);
		float weight_sum = 0.0;
		for (int y = -reach; y <= reach; ++y) {
			for (int x = -reach; x <= reach; ++x) {
				const ivec2 other = pixel + ivec2(x, y);
				if (!is_in_image(other)) {
					continue;
				}
				const uvec4 packed = load_pixel(other);
				if (get_material_key(packed) != receiver.material_key ||
						dot(unpack_normal(packed.y), receiver.normal) < MIN_COSINE) {
					continue;
				}
				const vec3 offset_m = position_from_depth(frame, other, get_depth(packed)) - receiver.position;
				if (abs(dot(offset_m, receiver.normal)) > float(reach) * receiver.pixel_size_m) {
					continue; // too far from the receiver's tangent plane
				}
				const float weight = (abs(x) == reach ? 0.5 : 1.0) * (abs(y) == reach ? 0.5 : 1.0);
				sum += weight * texelFetch(mask_texture, other, 0).rgb;
				weight_sum += weight;
			}
		}
		mask.rgb = sum / weight_sum; // the pixel itself always counts
	}
	imageStore(result_image, pixel, mask);
}
