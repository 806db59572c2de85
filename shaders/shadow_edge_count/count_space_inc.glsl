// Light space, and the light's disc as seen from a receiver: the float32 version of Receiver in
// modules/shadow_edge_count/count_in_double.cpp. Light space: metres, the light's centre at the origin (directional:
// its view's origin).
#ifndef COUNT_SPACE_INC_GLSL
#define COUNT_SPACE_INC_GLSL

#include "shadow_edge_count/shadow_edge_count_shared.h"

/// The light is directional. A constant, since software drivers would execute the code for other lights too.
layout(constant_id = EDGE_COUNT_CONSTANT_IS_DIRECTIONAL) const bool IS_DIRECTIONAL = false;

const float COUNT_FAR = 3e38; // beyond all distances

/// A receiver in light space, and the light's disc, which is turned to face it.
struct CountReceiver {
	vec3 position;
	// Dot products with these map an offset from the receiver to (X, d). d is 0 at the receiver and 1 in the disc's
	// plane (directional: metres towards the light). X / d is the covered point of that plane in metres (directional:
	// tangents).
	vec3 disc_x;
	vec3 disc_y;
	vec3 to_light; // towards the light, of length 1 / distance; directional: a unit vector
	float inverse_radius; // 1 / R; a light with R = 0 has no penumbra, and no edges are counted
	float min_d;		  // edges count only where d is above this: nearer to the light than the receiver
	float leaf_distance;	  // see CountLeaf; selects LODs
};

/// Edges count only where d is below this: in front of the light.
const float MAX_D = IS_DIRECTIONAL ? COUNT_FAR : 1.0;

float count_cross(vec2 p_a, vec2 p_b) {
	precise const float result = p_a.x * p_b.y - p_a.y * p_b.x;
	return result;
}

/// Three axes in light space.
struct CountFrame {
	vec3 x;
	vec3 y;
	vec3 z;
};

/// The frame with this z axis (unit), from the light to receivers. (Duff et al. 2017, "Building an Orthonormal Basis,
/// Revisited", listing 3.) A directional light has the axes of light space.
CountFrame make_count_frame(vec3 p_axis) {
	if (IS_DIRECTIONAL) {
		return CountFrame(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), vec3(0.0, 0.0, 1.0));
	}
	const float sign_z = p_axis.z >= 0.0 ? 1.0 : -1.0;
	const float a = -1.0 / (sign_z + p_axis.z);
	const float b = p_axis.x * p_axis.y * a;
	return CountFrame(vec3(1.0 + sign_z * p_axis.x * p_axis.x * a, sign_z * b, -sign_z * p_axis.x),
			vec3(b, sign_z + p_axis.y * p_axis.y * a, -p_axis.y), p_axis);
}

/// p_position must not be the light's centre.
CountReceiver make_count_receiver(CountLightConstants p_light, vec3 p_position, float p_leaf_distance) {
	const float square = max(dot(p_position, p_position), 1e-37);
	// disc_x x disc_y points from the light to the receiver.
	const CountFrame frame = make_count_frame(p_position * inversesqrt(square));
	return CountReceiver(p_position, frame.x, frame.y, IS_DIRECTIONAL ? vec3(0.0, 0.0, -1.0) : -p_position / square,
			1.0 / max(p_light.disc_radius, 1e-37), p_light.nearer_tolerance, p_leaf_distance);
}

/// (X, d) of a point. Equal points give equal bits, so that all tests of an edge's side agree. Points nearer to the
/// light than to the receiver are measured from the light, which avoids cancellation.
vec3 count_offset(CountReceiver p_receiver, vec3 p_point) {
	precise const vec3 o = p_point - p_receiver.position;
	if (IS_DIRECTIONAL) {
		return vec3(o.xy, -o.z);
	}
	precise const float from_light = dot(p_receiver.to_light, p_point);
	const bool is_near_light = from_light > -0.5;
	precise const vec3 offset = vec3(is_near_light ? p_point.x : o.x, is_near_light ? p_point.y : o.y,
			is_near_light ? p_point.z : o.z);
	precise const float x =
			p_receiver.disc_x.x * offset.x + p_receiver.disc_x.y * offset.y + p_receiver.disc_x.z * offset.z;
	precise const float y =
			p_receiver.disc_y.x * offset.x + p_receiver.disc_y.y * offset.y + p_receiver.disc_y.z * offset.z;
	return vec3(x, y, is_near_light ? 1.0 + from_light : dot(p_receiver.to_light, o));
}

/// True if the light's centre (X = 0) is to the left of an edge a -> b, given X of the edge's ends. Swapping a and b
/// inverts the result, also where the centre is on the edge: such ties are resolved as if the edge's X were moved by
/// (e, e^2), e > 0 and infinitesimal.
bool is_count_left(vec2 p_a, vec2 p_b) {
	const float side = count_cross(p_a, p_b);
	return side > 0.0 ||
			(side == 0.0 && (p_b.y > p_a.y || (p_b.y == p_a.y && p_b.x < p_a.x)));
}

/// True if a point r is in front of the face's plane (n, c), where n.r + c is above 0. No point is in front of a face
/// without area, whose plane is 0.
bool is_count_in_front(vec4 p_plane, vec3 p_point) {
	precise const float side = p_plane.x * p_point.x + p_plane.y * p_point.y + p_plane.z * p_point.z + p_plane.w;
	return side > 0.0;
}

/// True if the face is of the LOD that receivers of a leaf at this distance
/// see, see CountFaceRecord.
bool is_in_distance_range(float p_leaf_distance, CountFaceRecord p_face) {
	return p_leaf_distance >= uintBitsToFloat(p_face.b_first_distance.w) &&
			p_leaf_distance < uintBitsToFloat(p_face.c_end_distance.w);
}

/// As for a face, for all that is in a node.
bool is_in_distance_range(float p_leaf_distance, CountNode p_node) {
	return p_leaf_distance >= p_node.center_first_distance.w && p_leaf_distance < p_node.half_size_end_distance.w;
}

/// True if the light's centre is in front of the face.
bool is_count_light_in_front(vec4 p_plane) {
	return (IS_DIRECTIONAL ? -p_plane.z : p_plane.w) > 0.0;
}

#endif
