// Resolves a receiver's visibility by the six cases of figure 7 (Sun et al. 2010, section 2.2).
#ifndef RESOLVE_INC_GLSL
#define RESOLVE_INC_GLSL

#extension GL_EXT_control_flow_attributes : require

#include "shadow_penumbra_fins/bindings_inc.glsl"
#include "shadow_penumbra_fins/penumbra_inc.glsl"

layout(set = 0, binding = RESOLVE_BINDING_LAYER_3) uniform texture2DArray layer_3_texture;
// Linear; R visibility, G class (see penumbra_inc.glsl).
layout(set = 0, binding = RESOLVE_BINDING_COLOR) uniform sampler2DArray color_texture;
layout(set = 0, binding = RESOLVE_BINDING_PENUMBRA_DEPTH) uniform texture2DArray penumbra_depth_texture;
layout(constant_id = FINS_CONSTANT_HAS_INNER) const bool HAS_INNER = true;
layout(constant_id = FINS_CONSTANT_LAYER_COUNT) const uint LAYER_COUNT = 3u;
layout(constant_id = FINS_CONSTANT_STARTS_DARK) const bool STARTS_DARK = false;
layout(constant_id = FINS_CONSTANT_CURVE) const int CURVE = FINS_CURVE_SINE;

const uint CASE_NO_RECEIVER = 0u;
const uint CASE_OUTER_PENUMBRA = 1u;
const uint CASE_LIT = 2u;
const uint CASE_UMBRA_NO_FIN = 3u;
const uint CASE_UMBRA_OUTER_FIN = 4u; // hidden by layer 1, so the outer fin does not matter
const uint CASE_INNER_PENUMBRA = 5u;
const uint CASE_UMBRA_BEHIND = 6u; // behind the third layer

struct FinsResult {
	float visibility;
	uint case_number;
};

/// Summary of the 3 x 3 map texels around an undecided receiver: one whose class was interpolated between outer texels
/// and others.
struct Neighbourhood {
	bool has_outer;
	bool has_inner;
	bool has_occluder; // a texel without an outer fin hides the receiver
};

/// Reads texels only when p_is_needed. Otherwise all members of the result are false.
Neighbourhood search_neighbourhood(
		LightViewConstants p_view, MapPoint p_point, ivec2 p_texel, bool p_is_needed) {
	Neighbourhood found = Neighbourhood(false, false, false);
	// A loop that may run 0 times instead of a branch: software drivers execute the code that a branch skips.
	[[dont_unroll]] for (int i = p_is_needed ? 0 : 9; i < 9; ++i) {
		const ivec2 texel = clamp(
				p_texel + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(p_view.size_px) - 1);
		const ivec3 layer_texel = ivec3(texel, p_view.layer);
		const bool has_fin = texelFetch(penumbra_depth_texture, layer_texel, 0).r > 0.0;
		const bool is_outer = has_fin && texelFetch(color_texture, layer_texel, 0).g > 0.0;
		const bool is_occluding = compare_texel(p_view, p_point, texel,
									   texelFetch(layer_1_texture, layer_texel, 0).r) < 0.5;
		found.has_outer = found.has_outer || is_outer;
		found.has_inner = found.has_inner || (has_fin && !is_outer);
		found.has_occluder = found.has_occluder || (is_occluding && !is_outer);
	}
	return found;
}

FinsResult resolve_point(LightViewConstants p_view, MapPoint p_point) {
	const vec2 position_px = texels_from_map(p_view, p_point.xy);
	const ivec2 texel = ivec2(floor(position_px));
	if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(p_view.size_px)))) {
		return FinsResult(1.0, CASE_LIT);
	}
	const ivec3 layer_texel = ivec3(texel, p_view.layer);
	const vec2 color = textureLod(color_texture,
			vec3(position_px / vec2(p_view.size_px), float(p_view.layer)), 0.0).rg;
	const bool is_all_outer = color.g >= PENUMBRA_CLASS_OUTER - PENUMBRA_CLASS_TOLERANCE;
	const bool is_before_layer_1 = compare_texel(p_view, p_point, texel,
										   texelFetch(layer_1_texture, layer_texel, 0).r) > 0.5;
	const bool has_fin = texelFetch(penumbra_depth_texture, layer_texel, 0).r > 0.0;
	const bool is_before_layer_3 = !HAS_INNER || LAYER_COUNT < 3u ||
			compare_texel(p_view, p_point, texel, texelFetch(layer_3_texture, layer_texel, 0).r) > 0.5;
	// The class was interpolated between outer texels and others. The paper does not treat such receivers separately:
	// it treats them as lit when they are before layer 1, which leaves white specks along the silhouette, and does not
	// test them against the third layer, which leaves grey lines in the umbra.
	const bool is_undecided = !is_all_outer && color.g > PENUMBRA_CLASS_TOLERANCE;
	const Neighbourhood around = search_neighbourhood(p_view, p_point, texel,
			is_undecided && (is_before_layer_1 || (HAS_INNER && has_fin && is_before_layer_3)));
	const float edge_visibility = penumbra_edge_visibility(CURVE);
	if (is_before_layer_1) {
		if (is_all_outer) {
			return FinsResult(color.r, CASE_OUTER_PENUMBRA);
		}
		// Without inner fins, only outer texels contribute to color, so this quotient is their mean visibility. Where
		// fins are narrow, most of their pixels are interpolated with texels outside the fins, and end here.
		const float edge = STARTS_DARK
				? color.r * PENUMBRA_CLASS_OUTER / max(color.g, PENUMBRA_CLASS_TOLERANCE)
				: edge_visibility;
		return around.has_occluder ? FinsResult(edge, CASE_OUTER_PENUMBRA)
								 : FinsResult(1.0, CASE_LIT);
	}
	if (!has_fin) {
		return FinsResult(0.0, CASE_UMBRA_NO_FIN);
	}
	if (is_all_outer || !HAS_INNER) {
		return FinsResult(0.0, CASE_UMBRA_OUTER_FIN);
	}
	if (is_undecided) {
		return around.has_outer && around.has_inner ? FinsResult(edge_visibility, CASE_INNER_PENUMBRA)
				: is_before_layer_3					? FinsResult(0.0, CASE_UMBRA_NO_FIN)
													: FinsResult(0.0, CASE_UMBRA_BEHIND);
	}
	return is_before_layer_3 ? FinsResult(color.r, CASE_INNER_PENUMBRA)
							 : FinsResult(0.0, CASE_UMBRA_BEHIND);
}

/// Resolves one pixel: its visibility, and its case (CASE_*).
FinsResult resolve_pixel(ivec2 p_pixel) {
	if (!is_receiver_pixel(p_pixel)) {
		return FinsResult(0.0, CASE_NO_RECEIVER);
	}
	uint view;
	const MapPoint point = load_map_point(p_pixel, view);
	return is_trivially_lit(point, view, push.empty_views) ? FinsResult(1.0, CASE_LIT)
									  : resolve_point(light_views.views[view], point);
}

#endif
