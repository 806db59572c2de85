#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "godot_addon/convert_depth_inc.glsl"

layout(set = 0, binding = CONVERT_BINDING_DEPTH) uniform texture2DMS depth_texture;
layout(set = 0, binding = CONVERT_BINDING_PUBLISHED, r32f) uniform writeonly image2D published_image;

const float MAX_STEPS = 1.5;	  // difference of a surface's samples in one pixel / change per pixel
const float MAX_CURVATURE = 0.05; // deviation from a plane / change per pixel; below the receiver offset, 1 / 16
const float ROUNDING = 1e-6;	  // of depths, relative
const float NO_SURFACE = 1e30; // larger than each difference of depths

// Depth of the first sample of a pixel; negative outside of the image.
float fetch_first(ivec2 pixel) {
	const ivec2 size = textureSize(depth_texture);
	return any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))
			? -1.0
			: convert_depth(texelFetch(depth_texture, pixel, 0).r);
}

// Position of the first sample from the pixel's centre, in pixels: Vulkan's standard sample locations.
vec2 get_first_sample() {
	switch (textureSamples(depth_texture)) {
		case 2:
			return vec2(0.25, 0.25);
		case 4:
			return vec2(-0.125, -0.375);
		case 8:
			return vec2(0.0625, -0.1875);
		default:
			return vec2(0.0);
	}
}

// Returns the change of depth per pixel along an axis, on the surface at a pixel. Of the next two pixels on either side, those
// that are more nearly on a line with this pixel are on its surface; 0 if neither is.
float find_slope(ivec2 pixel, ivec2 axis, float here) {
	float slope = 0.0;
	float bend = NO_SURFACE;
	for (int side = -1; side <= 1; side += 2) {
		const float next = fetch_first(pixel + side * axis);
		const float second = fetch_first(pixel + 2 * side * axis);
		const float found = min(next, second) < 0.0 ? NO_SURFACE : abs(second - 2.0 * next + here);
		if (found < bend) {
			bend = found;
			slope = float(side) * (next - here);
		}
	}
	return bend <= abs(slope) ? slope : 0.0;
}

// Writes, also for materials, the depth of the first sample's surface at the pixel's centre. On a plane, near / z is linear
// over the image, and the samples' positions average to the centre. Where a curved surface turns away from the camera, the
// depth is rather too near than too far, so that the point is not behind the surface.
void main() {
	const ivec2 pixel = ivec2(gl_FragCoord.xy);
	const int count = textureSamples(depth_texture);
	const float first = fetch_first(pixel);
	const vec2 slope = vec2(find_slope(pixel, ivec2(1, 0), first), find_slope(pixel, ivec2(0, 1), first));
	const float step = abs(slope.x) + abs(slope.y);
	const float extrapolated = first - dot(slope, get_first_sample());
	float sum = 0.0;
	float nearest = first; // of the samples on the first one's surface
	bool is_one_surface = true;
	for (int index = 0; index < count; ++index) {
		const float depth = convert_depth(texelFetch(depth_texture, pixel, index).r);
		sum += depth;
		const bool is_same = abs(depth - first) <= MAX_STEPS * step + ROUNDING * first;
		is_one_surface = is_one_surface && is_same;
		nearest = is_same ? max(depth, nearest) : nearest;
	}
	const float mean = sum / float(count);
	float depth = 0.0;
	if (first > 0.0) {
		const bool is_flat = is_one_surface && abs(mean - extrapolated) <= MAX_CURVATURE * step + ROUNDING * first;
		depth = is_flat ? mean : max(extrapolated, nearest);
	}
	imageStore(published_image, pixel, vec4(depth));
	gl_FragDepth = depth;
}
