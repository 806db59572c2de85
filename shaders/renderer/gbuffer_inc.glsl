// What both G-buffers make of a surface.
#ifndef GBUFFER_INC_GLSL
#define GBUFFER_INC_GLSL
#include "renderer/renderer_shared.h"

/// The interpolated normal, or the face's where the mesh has none, on the side that is seen.
vec3 make_shading_normal(vec3 p_interpolated, vec3 p_geometric) {
	const bool has_normal = dot(p_interpolated, p_interpolated) > 0.0;
	const vec3 shading = has_normal ? normalize(p_interpolated) : p_geometric;
	return dot(shading, p_geometric) < 0.0 ? -shading : shading;
}

/// See make_surface of brdf_inc.glsl.
vec4 make_material(InstancePush p_instance) {
	return vec4(p_instance.scatter, p_instance.scatter_distance_m,
			p_instance.base_color_roughness.a, p_instance.emissive_metallic.a);
}

#endif
