#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "shadow_penumbra_fins/penumbra_inc.glsl"

// Sun et al. 2010, sections 2.1.2 and 2.1.3: discards fragments of fins whose edge is hidden from the light, and writes
// visibility, class (outer or inner) and depth of the others. Stored depths are reversed (1 near ..
// 0 far); in the comments, z, Z1 and Z2 are the paper's distances.
layout(location = 0) in float in_theta;
layout(location = 1) flat in uint in_is_outer;
layout(location = 0) out vec2 out_color;
layout(std140, set = 0, binding = FINS_BINDING_CONSTANTS) uniform Constants {
	FinsViewConstants view;
};
layout(set = 0, binding = FINS_BINDING_LAYER_1) uniform texture2DArray layer_1_texture;
layout(set = 0, binding = FINS_BINDING_LAYER_2) uniform texture2DArray layer_2_texture;
layout(constant_id = FINS_CONSTANT_STARTS_DARK) const bool STARTS_DARK = false;
layout(constant_id = FINS_CONSTANT_LAYER_COUNT) const uint LAYER_COUNT = 3u;
layout(constant_id = FINS_CONSTANT_CURVE) const int CURVE = FINS_CURVE_SINE;

void main() {
	const ivec3 texel = ivec3(gl_FragCoord.xy, view.layer);
	const float stored = clamp(gl_FragCoord.z, 0.0, 1.0); // as in the depth layers
	const float layer_1 = texelFetch(layer_1_texture, texel, 0).r;
	const bool is_outer = in_is_outer != 0u;
	const float distance_m = fin_distance(view, stored);
	bool is_visible;
	if (is_outer) {
		is_visible = stored > layer_1; // z < Z1
	} else {
		const float layer_2 = LAYER_COUNT > 1u ? texelFetch(layer_2_texture, texel, 0).r : 0.0;
		const bool is_near = layer_1 == 0.0 || // empty layer: Z1 is infinite
				distance_m <= fin_distance(view, layer_1) + view.beta_m;
		is_visible = stored >= layer_2 && is_near; // z <= Z2 and z <= Z1 + beta
	}
	if (!is_visible) {
		discard;
	}
	out_color = vec2(penumbra_transition(in_theta, is_outer, CURVE, STARTS_DARK),
			is_outer ? PENUMBRA_CLASS_OUTER : 0.0);
	gl_FragDepth = penumbra_depth(view, distance_m, is_outer);
}
