#version 460
#extension GL_GOOGLE_include_directive : require
#include "common/light_inc.glsl"

// Input: position and normal. Output: xyz illuminance per colour channel, w 1 if the point is a receiver, else 0.
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) readonly buffer Input {
	vec4 points[]; // two per item
};
layout(set = 0, binding = 1) writeonly buffer Output {
	vec4 results[];
};
layout(std140, set = 0, binding = 2) restrict readonly buffer Light {
	LightConstants light;
};

void main() {
	const uint item = gl_GlobalInvocationID.x;
	if (2u * item >= uint(points.length())) {
		return;
	}
	const vec3 position = points[2u * item].xyz;
	const vec3 normal = points[2u * item + 1u].xyz;
	results[item] = vec4(illuminance(light, vector_to_light(light, position)),
			is_receiver(light, position, normal) ? 1.0 : 0.0);
}
