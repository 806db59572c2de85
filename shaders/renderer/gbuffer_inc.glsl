// The surface values that gbuffer.frag and gbuffer_without_faces.frag write.
#ifndef GBUFFER_INC_GLSL
#define GBUFFER_INC_GLSL
#include "renderer/renderer_shared.h"

/// Returns the interpolated normal, or the geometric normal where the mesh has none, on the side of the geometric
/// normal.
vec3 make_shading_normal(vec3 p_interpolated, vec3 p_geometric) {
	const bool has_normal = dot(p_interpolated, p_interpolated) > 0.0;
	const vec3 shading = has_normal ? normalize(p_interpolated) : p_geometric;
	return dot(shading, p_geometric) < 0.0 ? -shading : shading;
}

/// The G-buffer's texels of a surface, see GBuffer in gbuffer.h.
struct SurfaceTexels {
	vec4 base_color; // a: ambient occlusion, 1 = open
	vec3 shading_normal;
	vec4 material; // see make_surface of brdf_inc.glsl
	vec3 emissive;
};

#ifdef VARIANT_TEXTURED

// The constants of the G-buffer pass are uniform blocks, because lavapipe 22.3 loads nothing from storage buffers in
// helper invocations, which derivatives need.
layout(set = 0, binding = GBUFFER_BINDING_MATERIAL) uniform Material {
	MaterialConstants material;
};
layout(set = 0, binding = GBUFFER_BINDING_BASE_COLOR) uniform sampler2D base_color_texture;
layout(set = 0,
		binding = GBUFFER_BINDING_METALLIC_ROUGHNESS) uniform sampler2D metallic_roughness_texture;
layout(set = 0, binding = GBUFFER_BINDING_NORMAL) uniform sampler2D normal_texture;
layout(set = 0, binding = GBUFFER_BINDING_OCCLUSION) uniform sampler2D occlusion_texture;
layout(set = 0, binding = GBUFFER_BINDING_EMISSIVE) uniform sampler2D emissive_texture;
// A constant and no branch on the material: lavapipe 22.3 clones and compiles a shader whose branches depend on uniforms
// alone at each draw that changes a uniform, and frees the clones with the pipeline only.
layout(constant_id = GBUFFER_CONSTANT_TEXTURES) const uint TEXTURES = 0u;
layout(location = 1) in vec4 in_uvs;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec4 in_color;

vec2 transform_uv(TextureTransform p_transform) {
	const vec3 uv = vec3(p_transform.row_u.a > 0.5 ? in_uvs.zw : in_uvs.xy, 1.0);
	return vec2(dot(p_transform.row_u.xyz, uv), dot(p_transform.row_v.xyz, uv));
}

/// Returns a texel, or white where the material has no such texture. p_has_texture: of TEXTURES. Software drivers take as
/// long for a white texture as for any other.
vec4 load_texel(uint p_has_texture, sampler2D p_texture, TextureTransform p_transform) {
	return (TEXTURES & p_has_texture) == 0u ? vec4(1.0) : texture(p_texture, transform_uv(p_transform));
}

/// Applies the normal map. p_normal: the result of make_shading_normal. p_is_mirrored: GBufferInstance::is_mirrored.
vec3 perturb_normal(vec3 p_normal, bool p_is_mirrored) {
	if ((TEXTURES & GBUFFER_HAS_NORMAL_MAP) == 0u) {
		return p_normal;
	}
	vec3 map = texture(normal_texture, transform_uv(material.normal)).xyz * 2.0 - 1.0;
	map.xy *= material.normal_scale;
	const vec3 tangent = in_tangent.xyz - p_normal * dot(p_normal, in_tangent.xyz);
	const vec3 unit_tangent = tangent * inversesqrt(max(dot(tangent, tangent), 1e-30));
	// w is the bitangent's sign as in glTF; a mirroring transform reverses it.
	const vec3 bitangent = cross(p_normal, unit_tangent) * (in_tangent.w < 0.0 != p_is_mirrored ? -1.0 : 1.0);
	const vec3 normal = unit_tangent * map.x + bitangent * map.y + p_normal * map.z;
	const float length2 = dot(normal, normal);
	return length2 > 0.0 ? normal * inversesqrt(length2) : p_normal;
}

/// Discards the fragment if its alpha is below the material's cutoff.
SurfaceTexels make_texels(GBufferInstance p_instance, vec3 p_normal) {
	const vec4 base_color = vec4(p_instance.base_color_roughness.rgb, material.alpha) * in_color *
			load_texel(GBUFFER_HAS_BASE_COLOR, base_color_texture, material.base_color);
	const vec3 metallic_roughness = load_texel(GBUFFER_HAS_METALLIC_ROUGHNESS, metallic_roughness_texture,
			material.metallic_roughness).rgb;
	const float occlusion = load_texel(GBUFFER_HAS_OCCLUSION, occlusion_texture, material.occlusion).r;
	const vec3 emissive = load_texel(GBUFFER_HAS_EMISSIVE, emissive_texture, material.emissive).rgb;
	const vec3 normal = perturb_normal(p_normal, p_instance.is_mirrored != 0u);
	if (base_color.a < material.alpha_cutoff) {
		discard;
	}
	const float factor = p_instance.base_color_roughness.a;
	// A negative factor is -1 - roughness and selects Phong's model; the texture scales the roughness.
	const float roughness = factor < 0.0 ? -1.0 + (factor + 1.0) * metallic_roughness.g
										 : factor * metallic_roughness.g;
	return SurfaceTexels(
			vec4(base_color.rgb, 1.0 + material.occlusion_strength * (occlusion - 1.0)), normal,
			vec4(p_instance.scatter, p_instance.scatter_distance_m, roughness,
					p_instance.emissive_metallic.a * metallic_roughness.b),
			p_instance.emissive_metallic.rgb * emissive);
}

#else

SurfaceTexels make_texels(GBufferInstance p_instance, vec3 p_normal) {
	return SurfaceTexels(vec4(p_instance.base_color_roughness.rgb, 1.0), p_normal,
			vec4(p_instance.scatter, p_instance.scatter_distance_m,
					p_instance.base_color_roughness.a, p_instance.emissive_metallic.a),
			p_instance.emissive_metallic.rgb);
}

#endif

#endif
