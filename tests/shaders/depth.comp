#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/depth_inc.glsl"

// Input: xy pixel, z stored depth. Output: xyz camera-relative position, w offset of its receiver,
// in metres.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 pixels[];
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(std140, set = 0, binding = 2) restrict readonly buffer Frame {
	FrameConstants frame;
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (item >= uint(pixels.length())) {
		return;
	}
	const vec4 pixel = pixels[item];
	results[item] = vec4(position_from_depth(frame, ivec2(pixel.xy), pixel.z),
			compute_receiver_offset_m(frame, distance_from_depth(frame, pixel.z)));
}
