// Unit vectors as two signed 16 bit numbers (octahedral mapping, error below 6.5e-5 rad).
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

#endif
