// Reflection of a light by a surface: Lambert and GGX as in appendix B of glTF 2.0, Phong 1975, and an approximation of
// the light that scatters below a translucent surface.
#ifndef BRDF_INC_GLSL
#define BRDF_INC_GLSL

const float PI = 3.14159265359;
const float MIN_ALPHA = 1e-3; // keeps the highlight of a perfect mirror finite
const float DIELECTRIC_F0 = 0.04; // reflectance at normal incidence, for an index of refraction of 1.5

/// A surface, as read from the G-buffer.
struct Surface {
	vec3 base_color;
	float scatter; // 0..1, see Material::scatter
	float roughness;
	float metallic;
	bool is_phong;
};

/// p_material: a texel of GBuffer::material: scatter, scatter_distance_m, roughness (-1 - roughness for Phong's model),
/// metallic.
Surface make_surface(vec3 p_base_color, vec4 p_material) {
	const bool is_phong = p_material.b < 0.0;
	return Surface(p_base_color, p_material.r > 0.0 ? min(p_material.r, 1.0) : 0.0,
			is_phong ? -1.0 - p_material.b : p_material.b, p_material.a, is_phong);
}

/// Cosines between unit vectors that point away from the surface: normal n, direction to the light l, direction to the
/// viewer v, half vector h, and r, the mirrored direction to the light.
struct ReflectionCosines {
	float n_l; // at most 0 if the light is behind the surface
	float n_v;
	float n_h;
	float v_h;
	float r_v;
};

/// Returns p_x^5. Cheaper than pow(), which is undefined below 0.
float power_of_5(float p_x) {
	const float x2 = p_x * p_x;
	return x2 * x2 * p_x;
}

ReflectionCosines compute_cosines(vec3 p_normal, vec3 p_to_viewer, vec3 p_to_light) {
	const vec3 half_vector = normalize(p_to_viewer + p_to_light);
	return ReflectionCosines(min(dot(p_normal, p_to_light), 1.0), clamp(dot(p_normal, p_to_viewer), 1e-4, 1.0),
			clamp(dot(p_normal, half_vector), 0.0, 1.0), clamp(dot(p_to_viewer, half_vector), 0.0, 1.0),
			clamp(dot(reflect(-p_to_light, p_normal), p_to_viewer), 0.0, 1.0));
}

/// Returns the factor by which a translucent surface reflects more or less light than a Lambert
/// reflector in this direction: the subsurface diffuse term of Burley 2012 (Physically based
/// shading at Disney, section 5.3, after Hanrahan and Krueger 1993). It reflects more than a
/// Lambert reflector at grazing angles.
float scatter_lobe(ReflectionCosines p_cosines, float p_roughness) {
	const float grazing = p_roughness * p_cosines.v_h * p_cosines.v_h;
	const float in_factor = mix(1.0, grazing, power_of_5(1.0 - p_cosines.n_l));
	const float out_factor = mix(1.0, grazing, power_of_5(1.0 - p_cosines.n_v));
	return 1.25 * (in_factor * out_factor * (1.0 / (p_cosines.n_l + p_cosines.n_v) - 0.5) + 0.5);
}

/// GGX with the height-correlated Smith term: distribution times visibility, without the Fresnel term.
float ggx_lobe(ReflectionCosines p_cosines, float p_roughness) {
	const float alpha = max(p_roughness * p_roughness, MIN_ALPHA);
	const float alpha2 = alpha * alpha;
	const float d_base = p_cosines.n_h * p_cosines.n_h * (alpha2 - 1.0) + 1.0;
	const float distribution = alpha2 / (PI * d_base * d_base);
	const float n_l = p_cosines.n_l;
	const float n_v = p_cosines.n_v;
	const float visibility = 0.5 /
			(n_l * sqrt(n_v * n_v * (1.0 - alpha2) + alpha2) +
					n_v * sqrt(n_l * n_l * (1.0 - alpha2) + alpha2));
	return distribution * visibility;
}

/// Phong's lobe around the mirrored light direction as a BRDF, without the cosine, normalised to
/// reflect at most 1 (Lewis 1994). 2 / alpha^2 - 2 is the exponent of the Blinn-Phong distribution
/// with GGX's maximum; Phong's is a quarter of it, because the angle between r and v is twice that
/// between n and h.
float phong_lobe(ReflectionCosines p_cosines, float p_roughness) {
	const float alpha = max(p_roughness * p_roughness, MIN_ALPHA);
	const float exponent = max(2.0 / (alpha * alpha) - 2.0, 0.0) * 0.25;
	return (exponent + 2.0) / (2.0 * PI) * pow(max(p_cosines.r_v, 1e-6), exponent);
}

/// Returns the reflected radiance per illuminance, including the cosine. All vectors are unit vectors that point away
/// from the surface.
vec3 reflect_light(Surface p_surface, vec3 p_normal, vec3 p_to_viewer, vec3 p_to_light) {
	const ReflectionCosines cosines = compute_cosines(p_normal, p_to_viewer, p_to_light);
	if (cosines.n_l <= 0.0) {
		return vec3(0.0);
	}
	const vec3 f0 = mix(vec3(DIELECTRIC_F0), p_surface.base_color, p_surface.metallic);
	vec3 fresnel;
	float lobe;
	if (p_surface.is_phong) {
		fresnel = f0;
		lobe = phong_lobe(cosines, p_surface.roughness);
	} else {
		fresnel = f0 + (1.0 - f0) * power_of_5(1.0 - cosines.v_h);
		lobe = ggx_lobe(cosines, p_surface.roughness);
	}
	vec3 diffuse = (1.0 - fresnel) * (1.0 - p_surface.metallic) * p_surface.base_color / PI;
	if (p_surface.scatter > 0.0) {
		diffuse *= mix(1.0, scatter_lobe(cosines, p_surface.roughness), p_surface.scatter);
	}
	return (diffuse + fresnel * lobe) * cosines.n_l;
}

#endif
