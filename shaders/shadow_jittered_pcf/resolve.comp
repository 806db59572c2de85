#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "common/map_resolve_inc.glsl"
#include "common/map_tap_inc.glsl"
#include "shadow_jittered_pcf/shadow_jittered_pcf_shared.h"

// Averages comparisons with the depth map over jittered taps on a disc (see ShadowJitteredPcf).
layout(set = 0, binding = DEPTH_MAP_BINDING_MAP) uniform texture2DArray map_texture;
layout(std430, set = 0, binding = JITTERED_PCF_BINDING_OFFSETS) readonly buffer Offsets {
	vec4 offsets[]; // two tap offsets in each, see build_jitter_offsets
};
layout(set = 0, binding = DEPTH_MAP_BINDING_MASK, r16f) uniform writeonly image2D mask_image;
layout(push_constant) uniform Push {
	JitteredPcfPush push;
};

float find_visibility(ivec2 p_pixel) {
	uint view_index;
	const MapPoint point = load_map_point(p_pixel, view_index);
	const LightViewConstants view = light_views.views[view_index];
	if (is_behind_view(view, point)) {
		return 1.0;
	}
	const float margin = hiding_margin(view, point);
	const vec2 radius = 2.0 * push.radius_uv * view.half_extent;
	const uvec2 cell = uvec2(p_pixel) % JITTERED_PCF_SETS_PER_SIDE;
	const uint tap_count = push.ring_count * JITTERED_PCF_TAPS_PER_RING;
	// Index of the set's first pair of offsets.
	const uint first = (cell.y * JITTERED_PCF_SETS_PER_SIDE + cell.x) * tap_count / 2u;
	uint hidden_count = 0u;
	uint end = push.has_early_out != 0u ? JITTERED_PCF_TAPS_PER_RING : tap_count;
	uint tap = 0u;
	while (tap < end) {
		const vec4 pair = offsets[first + tap / 2u];
		float w; // of the occluder; not used here
		hidden_count += is_hidden_at(map_texture, push.empty_views, view, point, margin,
								point.xy + radius * pair.xy, w)
				? 1u
				: 0u;
		hidden_count += is_hidden_at(map_texture, push.empty_views, view, point, margin,
								point.xy + radius * pair.zw, w)
				? 1u
				: 0u;
		tap += 2u;
		// When the outermost ring is neither all lit nor all hidden, the other rings are sampled, too.
		end = tap == end && hidden_count != 0u && hidden_count != tap ? tap_count : end;
	}
	return 1.0 - float(hidden_count) / float(tap);
}

void main() {
	const ivec2 pixel = find_pixel();
	if (is_in_image(pixel)) {
		imageStore(mask_image, pixel,
				vec4(is_receiver_pixel(pixel) ? find_visibility(pixel) : 0.0));
	}
}
