// The unshadowed light at a point.
#ifndef LIGHT_INC_GLSL
#define LIGHT_INC_GLSL

#include "shared/light_shared.h"

/// Vector from the point to the light's centre, not normalized: its length is the distance in
/// metres (directional: 1).
vec3 vector_to_light(LightConstants p_light, vec3 p_position) {
	return p_light.type == LIGHT_TYPE_DIRECTIONAL ? -p_light.direction.xyz
												  : p_light.position_radius.xyz - p_position;
}

/// True when the point receives light if nothing is in between: its surface faces the light, and it is inside the
/// light's cone and range (see receiver in doc/glossary.md).
bool is_receiver(LightConstants p_light, vec3 p_position, vec3 p_normal) {
	const vec3 to_light = vector_to_light(p_light, p_position);
	const float distance_m = length(to_light);
	if (!(dot(p_normal, to_light) > LIGHT_MIN_COSINE * distance_m)) {
		return false; // also for a point on the light, and NaN
	}
	if (p_light.type == LIGHT_TYPE_DIRECTIONAL) {
		return true;
	}
	if (p_light.range_m > 0.0 && distance_m > p_light.range_m) {
		return false;
	}
	return p_light.type != LIGHT_TYPE_SPOT ||
			dot(-to_light, p_light.direction.xyz) >= p_light.cos_outer * distance_m;
}

/// Illuminance on a surface perpendicular to the light's direction, lx per colour: KHR_lights_punctual's attenuation
/// with its range window and smooth cone, without the cosine at the surface. p_to_light: see vector_to_light.
vec3 illuminance(LightConstants p_light, vec3 p_to_light) {
	const bool is_directional = p_light.type == LIGHT_TYPE_DIRECTIONAL;
	// The lower limits only avoid divisions by 0.
	const float distance2 = max(dot(p_to_light, p_to_light), 1e-12);
	const float ratio2 = distance2 / max(p_light.range_m * p_light.range_m, 1e-30);
	const float window = clamp(1.0 - ratio2 * ratio2, 0.0, 1.0);
	const float cosine = dot(-p_to_light, p_light.direction.xyz) * inversesqrt(distance2);
	const float span = max(p_light.cos_inner - p_light.cos_outer, 1e-4);
	const float cone = clamp((cosine - p_light.cos_outer) / span, 0.0, 1.0);
	const float attenuation = 1.0 / distance2 * (p_light.range_m > 0.0 ? window : 1.0) *
			(p_light.type == LIGHT_TYPE_SPOT ? cone * cone : 1.0);
	return p_light.intensity.rgb * (is_directional ? 1.0 : attenuation);
}

#endif
