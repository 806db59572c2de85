#version 460
// For the tests of the device: one binding of each kind except storage buffers, which scale.comp has.
layout(local_size_x = 8, local_size_y = 4, local_size_z = 1) in;
layout(set = 0, binding = 0) uniform Constants { uvec4 constants; };
layout(set = 0, binding = 1) uniform usamplerBuffer texel_values;
layout(set = 0, binding = 2) uniform sampler2D combined;
layout(set = 0, binding = 3) uniform texture2DArray layers;
layout(set = 0, binding = 4) uniform sampler nearest;
layout(set = 0, binding = 5, r32f) uniform writeonly image2D result;

void main() {
	const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
	if (any(greaterThanEqual(texel, imageSize(result)))) {
		return;
	}
	const float value = float(constants.x) + float(texelFetch(texel_values, texel.x).x) +
			texelFetch(combined, texel, 0).x +
			textureLod(sampler2DArray(layers, nearest), vec3(0.5, 0.5, 1.0), 0.0).x;
	imageStore(result, texel, vec4(value));
}
