// Lambert and GGX, as glTF 2.0 appendix B describes its metallic-roughness material.
#ifndef BRDF_INC_GLSL
#define BRDF_INC_GLSL

const float PI = 3.14159265359;

/// Reflected radiance per illuminance, cosine included. All vectors unit, pointing away.
vec3 reflect_light(vec3 p_base_color, float p_metallic, float p_roughness, vec3 p_normal,
		vec3 p_to_viewer, vec3 p_to_light) {
	const float n_l = dot(p_normal, p_to_light);
	if (n_l <= 0.0) {
		return vec3(0.0);
	}
	const vec3 half_vector = normalize(p_to_viewer + p_to_light);
	const float n_v = max(dot(p_normal, p_to_viewer), 1e-4);
	const float n_h = clamp(dot(p_normal, half_vector), 0.0, 1.0);
	const float v_h = clamp(dot(p_to_viewer, half_vector), 0.0, 1.0);
	const float alpha = max(p_roughness * p_roughness, 1e-3);
	const float alpha2 = alpha * alpha;
	const float d_base = n_h * n_h * (alpha2 - 1.0) + 1.0;
	const float distribution = alpha2 / (PI * d_base * d_base);
	const float visibility = 0.5 /
			(n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2) +
					n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2));
	const vec3 f0 = mix(vec3(0.04), p_base_color, p_metallic);
	const vec3 fresnel = f0 + (1.0 - f0) * pow(1.0 - v_h, 5.0);
	const vec3 diffuse = (1.0 - fresnel) * (1.0 - p_metallic) * p_base_color / PI;
	return (diffuse + fresnel * distribution * visibility) * n_l;
}

#endif
