// Packs a unit vector into two signed normalized 16-bit numbers (octahedral mapping, error below 7e-5 rad).
#ifndef NORMAL_INC_GLSL
#define NORMAL_INC_GLSL

vec2 sign_not_zero(vec2 p_value) {
	return vec2(p_value.x >= 0.0 ? 1.0 : -1.0, p_value.y >= 0.0 ? 1.0 : -1.0);
}

uint pack_normal(vec3 p_normal) {
	const vec3 n = p_normal / (abs(p_normal.x) + abs(p_normal.y) + abs(p_normal.z));
	const vec2 folded = n.z >= 0.0 ? n.xy : (1.0 - abs(n.yx)) * sign_not_zero(n.xy);
	return packSnorm2x16(folded);
}

vec3 unpack_normal(uint p_packed) {
	const vec2 folded = unpackSnorm2x16(p_packed);
	vec3 n = vec3(folded, 1.0 - abs(folded.x) - abs(folded.y));
	if (n.z < 0.0) {
		n.xy = (1.0 - abs(n.yx)) * sign_not_zero(n.xy);
	}
	return normalize(n);
}

/// Unit normal of a camera-relative triangle, on the side that the camera sees. Along z for a triangle without area.
vec3 face_normal_to_viewer(vec3 p_a, vec3 p_b, vec3 p_c) {
	const vec3 ab = p_b - p_a;
	const vec3 ac = p_c - p_a;
	// Scaled first, so that the cross product of a tiny triangle does not underflow.
	const float scale = max(max(max(abs(ab.x), abs(ab.y)), abs(ab.z)),
			max(max(abs(ac.x), abs(ac.y)), abs(ac.z)));
	vec3 normal = cross(ab / scale, ac / scale);
	const float length2 = dot(normal, normal);
	normal = length2 > 0.0 ? normal * inversesqrt(length2) : vec3(0.0, 0.0, 1.0);
	return dot(normal, p_a) > 0.0 ? -normal : normal;
}

#endif
