// Visibility of one receiver in a light's depth map.
#ifndef LOOKUP_INC_GLSL
#define LOOKUP_INC_GLSL

#include "common/map_compare_inc.glsl"

/// Percentage-closer filter: the mean over a box of p_width x p_width texels around the receiver.
/// Each texel is weighted by the fraction of it that the box covers, so that the result is
/// continuous. Texels outside the map count as lit.
float lookup_filtered(
		texture2DArray p_map, LightViewConstants p_view, MapPoint p_point, int p_width) {
	const vec2 low = texels_from_map(p_view, p_point.xy) - 0.5 * float(p_width);
	const ivec2 first = ivec2(floor(low));
	float lit = 0.0;
	float total = 0.0; // summed in the same order as `lit`, so that all lit is exactly 1
	for (int y = 0; y <= p_width; ++y) {
		for (int x = 0; x <= p_width; ++x) {
			const ivec2 texel = first + ivec2(x, y);
			const vec2 start = max(vec2(texel), low);
			const vec2 end = min(vec2(texel + 1), low + float(p_width));
			const vec2 covered = max(end - start, vec2(0.0));
			const bool is_outside = any(lessThan(texel, ivec2(0))) ||
					any(greaterThanEqual(texel, ivec2(p_view.size_px)));
			const float value = is_outside
					? 1.0
					: compare_texel(p_view, p_point, texel,
							  texelFetch(p_map, ivec3(texel, p_view.layer), 0).r);
			lit += covered.x * covered.y * value;
			total += covered.x * covered.y;
		}
	}
	return lit / total;
}

#endif
