// The space in which receivers count edges: CountSpace and DiscProjection in float32.
#ifndef COUNT_SPACE_INC_GLSL
#define COUNT_SPACE_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

/// A receiver in a light view.
struct CountReceiver {
	vec3 r;		// metres, the light's centre at the origin
	vec3 normal; // unit, of the face, in the view's axes
	vec3 warped; // x', y', w
	vec2 slope;	 // of its plane: w per x' and y'
	float scale; // of tolerances: w; directional: metres
	float inverse_radius; // 1 / R; R = 0 has no penumbra, and no edge is asked for it
	// Of the disc that faces it: see count_project.
	vec2 side;
	float turn;
	float depth_turn;
};

float count_cross(vec2 p_a, vec2 p_b) {
	return p_a.x * p_b.y - p_a.y * p_b.x;
}

vec3 count_warp(CountViewConstants p_view, vec3 p_r) {
	return p_view.is_directional != 0u ? vec3(p_r.xy, p_view.depth_far_m - p_r.z)
									   : vec3(p_r.xy, 1.0) / p_r.z;
}

/// What a relative tolerance of w is a share of; see CountSpace.
float count_depth_scale(CountViewConstants p_view, float p_w) {
	return p_view.is_directional != 0u ? p_view.depth_scale_m : p_w;
}

/// Above 0 where the face is turned to the light's centre.
float count_light_side(CountViewConstants p_view, vec3 p_normal, float p_distance) {
	return p_view.is_directional != 0u ? -p_normal.z : p_distance;
}

CountReceiver make_count_receiver(CountViewConstants p_view, vec3 p_r, vec3 p_normal) {
	const float FLAT_NORMAL = 1e-7; // the receiver is seen edge on: no slope
	CountReceiver receiver;
	receiver.r = p_r;
	receiver.normal = p_normal;
	receiver.inverse_radius = 1.0 / max(p_view.disc_radius, 1e-37);
	receiver.warped = count_warp(p_view, p_r);
	const bool is_directional = p_view.is_directional != 0u;
	receiver.scale = count_depth_scale(p_view, receiver.warped.z);
	const float depth_slope = is_directional ? p_normal.z : dot(p_normal, p_r);
	const float least = FLAT_NORMAL * (is_directional ? 1.0 : length(p_r));
	receiver.slope = abs(depth_slope) >= least ? p_normal.xy / depth_slope : vec2(0.0);
	const float rho = length(p_r);
	const bool turns = !is_directional && rho > 0.0;
	receiver.side = turns ? p_r.xy : vec2(0.0);
	receiver.turn = turns ? 1.0 / (rho * (rho + p_r.z)) : 0.0;
	receiver.depth_turn = turns ? 1.0 / (rho * rho) : 0.0;
	return receiver;
}

/// An offset (A, d) = (q' - p', w_q - w_p) so that A / d is a point of the plane of the disc that
/// faces the receiver.
vec3 count_project(CountReceiver p_receiver, vec3 p_offset) {
	const float along = dot(p_offset.xy, p_receiver.side);
	return vec3(p_offset.xy - p_receiver.side * (p_receiver.turn * along),
			p_offset.z - along * p_receiver.depth_turn);
}

/// w that the receiver's plane gains from the receiver to an offset in x', y'.
float count_rise(CountReceiver p_receiver, vec2 p_offset) {
	return dot(p_receiver.slope, p_offset);
}

/// w of its plane there, never below the receiver: the plane's own fall is no shadow.
float count_plane_w(CountReceiver p_receiver, vec2 p_offset) {
	return p_receiver.warped.z + max(count_rise(p_receiver, p_offset), 0.0);
}

#endif
