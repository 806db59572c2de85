// Light space, and the light's disc as seen from a receiver: CountReceiver and count_offset of
// count_in_double.h in float32. Light space: metres, the light's centre at the origin (directional:
// its view's origin).
#ifndef COUNT_SPACE_INC_GLSL
#define COUNT_SPACE_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

const float COUNT_MOST_D = 3e38;

/// A receiver in light space, and the disc of the light that faces it.
struct CountReceiver {
	vec3 position;
	// An offset from the receiver to (X, d), X / d a point of the disc's plane in metres (directional:
	// tangents), d = 0 at the receiver and 1 in the disc's plane (directional: metres towards the light).
	vec3 disc_x;
	vec3 disc_y;
	vec3 to_light;
	float inverse_radius; // 1 / R; R = 0 has no penumbra, and no edge is counted for it
	float least_d;		  // an edge counts only where it is nearer to the light than this
	float most_d;		  // and not behind the light
	float least_near;	  // of dot(to_light, point): it is nearer to the light than to the receiver
};

float count_cross(vec2 p_a, vec2 p_b) {
	precise const float result = p_a.x * p_b.y - p_a.y * p_b.x;
	return result;
}

/// p_position: never the light's centre itself.
CountReceiver make_count_receiver(CountLightConstants p_light, vec3 p_position) {
	CountReceiver receiver;
	receiver.position = p_position;
	receiver.inverse_radius = 1.0 / max(p_light.disc_radius, 1e-37);
	receiver.least_d = p_light.nearer_tolerance;
	if (p_light.is_directional != 0u) {
		receiver.disc_x = vec3(1.0, 0.0, 0.0);
		receiver.disc_y = vec3(0.0, 1.0, 0.0);
		receiver.to_light = vec3(0.0, 0.0, -1.0);
		receiver.least_near = COUNT_MOST_D;
		receiver.most_d = COUNT_MOST_D;
		return receiver;
	}
	// An orthonormal basis (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3):
	// disc_x x disc_y points from the light to the receiver.
	const float square = max(dot(p_position, p_position), 1e-37);
	const vec3 n = p_position * inversesqrt(square);
	const float turn = n.z >= 0.0 ? 1.0 : -1.0;
	const float a = -1.0 / (turn + n.z);
	const float b = n.x * n.y * a;
	receiver.disc_x = vec3(1.0 + turn * n.x * n.x * a, turn * b, -turn * n.x);
	receiver.disc_y = vec3(b, turn + n.y * n.y * a, -n.y);
	receiver.to_light = -p_position / square;
	receiver.least_near = -0.5;
	receiver.most_d = 1.0;
	return receiver;
}

/// (X, d) of a point. Equal points give equal bits: every side of an edge is made of these. Points nearer to the
/// light than to the receiver are measured from the light: a difference would lose what they are small by.
vec3 count_offset(CountReceiver p_receiver, vec3 p_point) {
	precise const vec3 o = p_point - p_receiver.position;
	precise const float from_light = dot(p_receiver.to_light, p_point);
	const bool is_near_light = from_light > p_receiver.least_near;
	precise const vec3 way = vec3(is_near_light ? p_point.x : o.x, is_near_light ? p_point.y : o.y,
			is_near_light ? p_point.z : o.z);
	precise const float x =
			p_receiver.disc_x.x * way.x + p_receiver.disc_x.y * way.y + p_receiver.disc_x.z * way.z;
	precise const float y =
			p_receiver.disc_y.x * way.x + p_receiver.disc_y.y * way.y + p_receiver.disc_y.z * way.z;
	return vec3(x, y, is_near_light ? 1.0 + from_light : dot(p_receiver.to_light, o));
}

/// Which side of the way from the receiver to the light's centre an edge a -> b passes, from X of its ends.
/// Changing a and b changes the answer, also where the way meets the edge: there it is as if the receiver
/// were moved by (e, e^2), e > 0 and infinitely small.
bool is_count_left(vec2 p_a, vec2 p_b) {
	const float side = count_cross(p_a, p_b);
	return side > 0.0 ||
			(side == 0.0 && (p_b.y > p_a.y || (p_b.y == p_a.y && p_b.x < p_a.x)));
}

/// True where a point is in front of the face n.r + d = 0. A face without area, all 0, has none before it.
bool is_count_before(vec4 p_plane, vec3 p_point) {
	precise const float side = p_plane.x * p_point.x + p_plane.y * p_point.y + p_plane.z * p_point.z + p_plane.w;
	return side > 0.0;
}

/// True where the light's centre is in front of the face.
bool is_count_light_before(bool p_is_directional, vec4 p_plane) {
	return (p_is_directional ? -p_plane.z : p_plane.w) > 0.0;
}

#endif
