// How surfaces reflect a light: glTF 2.0 appendix B's Lambert and GGX, Phong 1975, and an approximation
// of what scatters below a translucent one.
#ifndef BRDF_INC_GLSL
#define BRDF_INC_GLSL

const float PI = 3.14159265359;
const float DIELECTRIC = 0.04; // reflected straight back, of an index of refraction of 1.5

/// A surface as the G-buffer has it.
struct Surface {
	vec3 base_color;
	float scatter; // s in 0..1
	float roughness;
	float metallic;
	bool is_phong;
};

/// p_material: a texel of the G-buffer's material: s, scatter_distance_m, roughness (-1 - roughness for
/// Phong's model), metallic.
Surface make_surface(vec3 p_base_color, vec4 p_material) {
	const bool is_phong = p_material.b < 0.0;
	return Surface(p_base_color, p_material.r > 0.0 ? min(p_material.r, 1.0) : 0.0,
			is_phong ? -1.0 - p_material.b : p_material.b, p_material.a, is_phong);
}

/// Angles between unit vectors that point away from the surface.
struct ReflectAngles {
	float n_l; // above 0
	float n_v;
	float n_h;
	float v_h;
	float r_v; // of the mirrored light
};

/// pow(x, 5) is not defined below 0, where rounding may lead.
float power_of_5(float p_x) {
	const float x2 = p_x * p_x;
	return x2 * x2 * p_x;
}

ReflectAngles find_angles(vec3 p_normal, vec3 p_to_viewer, vec3 p_to_light) {
	const vec3 half_vector = normalize(p_to_viewer + p_to_light);
	return ReflectAngles(min(dot(p_normal, p_to_light), 1.0), clamp(dot(p_normal, p_to_viewer), 1e-4, 1.0),
			clamp(dot(p_normal, half_vector), 0.0, 1.0), clamp(dot(p_to_viewer, half_vector), 0.0, 1.0),
			clamp(dot(reflect(-p_to_light, p_normal), p_to_viewer), 0.0, 1.0));
}

/// Share of a Lambert reflector's light that a translucent surface sends this way: the flat lobe of
/// Burley 2012 (Physically based shading at Disney, section 5.3, after Hanrahan and Krueger 1993). It
/// lifts grazing light, as what comes from below the surface has lost the direction it came from.
float scatter_lobe(ReflectAngles p_angles, float p_roughness) {
	const float grazing = p_roughness * p_angles.v_h * p_angles.v_h;
	const float in_share = mix(1.0, grazing, power_of_5(1.0 - p_angles.n_l));
	const float out_share = mix(1.0, grazing, power_of_5(1.0 - p_angles.n_v));
	return 1.25 * (in_share * out_share * (1.0 / (p_angles.n_l + p_angles.n_v) - 0.5) + 0.5);
}

/// GGX with the height-correlated Smith term: distribution times visibility, without Fresnel's.
float ggx_lobe(ReflectAngles p_angles, float p_roughness) {
	const float alpha = max(p_roughness * p_roughness, 1e-3);
	const float alpha2 = alpha * alpha;
	const float d_base = p_angles.n_h * p_angles.n_h * (alpha2 - 1.0) + 1.0;
	const float distribution = alpha2 / (PI * d_base * d_base);
	const float n_l = p_angles.n_l;
	const float n_v = p_angles.n_v;
	const float visibility = 0.5 /
			(n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2) +
					n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2));
	return distribution * visibility;
}

/// Phong's lobe about the mirrored light, over the cosine, normalised to reflect at most 1 (Lewis 1994).
/// Its exponent has GGX's width near the middle.
float phong_lobe(ReflectAngles p_angles, float p_roughness) {
	const float alpha = max(p_roughness * p_roughness, 1e-3);
	const float exponent = max(2.0 / (alpha * alpha) - 2.0, 0.0) * 0.25;
	return (exponent + 2.0) / (2.0 * PI) * pow(max(p_angles.r_v, 1e-6), exponent);
}

/// Reflected radiance per illuminance, cosine included. All vectors unit, pointing away.
vec3 reflect_light(Surface p_surface, vec3 p_normal, vec3 p_to_viewer, vec3 p_to_light) {
	const ReflectAngles angles = find_angles(p_normal, p_to_viewer, p_to_light);
	if (angles.n_l <= 0.0) {
		return vec3(0.0);
	}
	const vec3 f0 = mix(vec3(DIELECTRIC), p_surface.base_color, p_surface.metallic);
	vec3 fresnel;
	float lobe;
	if (p_surface.is_phong) {
		fresnel = f0;
		lobe = phong_lobe(angles, p_surface.roughness);
	} else {
		fresnel = f0 + (1.0 - f0) * power_of_5(1.0 - angles.v_h);
		lobe = ggx_lobe(angles, p_surface.roughness);
	}
	vec3 diffuse = (1.0 - fresnel) * (1.0 - p_surface.metallic) * p_surface.base_color / PI;
	if (p_surface.scatter > 0.0) {
		diffuse *= mix(1.0, scatter_lobe(angles, p_surface.roughness), p_surface.scatter);
	}
	return (diffuse + fresnel * lobe) * angles.n_l;
}

#endif
