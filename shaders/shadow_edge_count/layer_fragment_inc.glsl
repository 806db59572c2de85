// One face over one texel of the layer map, as a word. For fragment shaders behind layers.vert.
#ifndef LAYER_FRAGMENT_INC_GLSL
#define LAYER_FRAGMENT_INC_GLSL

#include "shadow_edge_count/count_space_inc.glsl"

layout(set = 0, binding = LAYERS_BINDING_VIEW) uniform View {
	CountViewConstants view;
};
layout(std430, set = 0, binding = LAYERS_BINDING_PLANES) readonly buffer Planes {
	vec4 planes_view[];
};
layout(push_constant) uniform Push {
	CountLayersPush push;
};

/// The bits of the face's w at the texel's centre, the lowest two replaced by LAYERS_TOWARD, _AWAY or
/// _DOUBLE_SIDED. 0 where it has none.
uint make_layer_fragment(uvec2 p_texel) {
	const vec4 plane = planes_view[push.first_face + uint(gl_PrimitiveID)];
	// The face's plane, solved for w: exact at the centre, however steep the face.
	const vec2 point =
			((vec2(p_texel) + 0.5) / vec2(view.map_size_px) * 2.0 - 1.0) * view.half_extent;
	const float along = dot(plane.xy, point);
	const float w = view.is_directional != 0u ? view.depth_far_m + (along + plane.w) / plane.z
											  : -(along + plane.z) / plane.w;
	const uint kind = (push.kind & uint(EDGE_COUNT_DOUBLE_SIDED)) != 0u ? LAYERS_DOUBLE_SIDED
			: count_light_side(view, plane.xyz, plane.w) > 0.0			  ? LAYERS_TOWARD
																		  : LAYERS_AWAY;
	// Behind the light, or of a face without area: no receiver lies behind it.
	return w > 0.0 && w < 1e30 ? (floatBitsToUint(w) & ~LAYERS_KIND_MASK) | kind : 0u;
}

#endif
