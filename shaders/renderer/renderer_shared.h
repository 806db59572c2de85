#ifndef RENDERER_SHARED_H
#define RENDERER_SHARED_H
#include "shared/shared_begin.h"

// Bindings of the renderer's compute passes (ambient, lighting, tone map, debug view, mask error).
#define RENDERER_BINDING_FRAME 0
#define RENDERER_BINDING_LIGHT 1
#define RENDERER_BINDING_DEPTH 2
#define RENDERER_BINDING_SHADING_NORMAL 4
#define RENDERER_BINDING_MATERIAL 5
#define RENDERER_BINDING_BASE_COLOR 6
#define RENDERER_BINDING_EMISSIVE 7
#define RENDERER_BINDING_RECEIVERS 8
#define RENDERER_BINDING_MASK 9
#define RENDERER_BINDING_RADIANCE 10
#define RENDERER_BINDING_OUTPUT 11
#define RENDERER_BINDING_REFERENCE 12
#define RENDERER_BINDING_TILES 13
#define RENDERER_GROUP_SIZE 8
// Upper limit of the exposed radiance, just below the largest half float, 65504.
#define RENDERER_MAX_RADIANCE 6e4

#define PRESENT_BINDING_IMAGE 0

#define GBUFFER_BINDING_FRAME 0
#define GBUFFER_BINDING_POSITIONS 1
#define GBUFFER_BINDING_INDICES 2
// Only for surfaces with textures, vertex colours or an alpha cutoff.
#define GBUFFER_BINDING_MATERIAL 3
#define GBUFFER_BINDING_BASE_COLOR 4
#define GBUFFER_BINDING_METALLIC_ROUGHNESS 5
#define GBUFFER_BINDING_NORMAL 6
#define GBUFFER_BINDING_OCCLUSION 7
#define GBUFFER_BINDING_EMISSIVE 8
#define GBUFFER_BINDING_INSTANCES 9 // GBufferInstance, indexed by gl_InstanceIndex
// Which textures the material has: a sum of the values below. The others are not read.
#define GBUFFER_CONSTANT_TEXTURES 0
#define GBUFFER_HAS_BASE_COLOR 1u
#define GBUFFER_HAS_METALLIC_ROUGHNESS 2u
#define GBUFFER_HAS_NORMAL_MAP 4u
#define GBUFFER_HAS_OCCLUSION 8u
#define GBUFFER_HAS_EMISSIVE 16u

/// One drawn surface, for gbuffer.vert, gbuffer.frag and gbuffer_without_faces.frag.
struct SHARED_ALIGN GBufferInstance {
	mat4 camera_relative_from_node;
	vec4 base_color_roughness; // rgb linear; a: roughness, or -1 - roughness for Phong's model
	vec4 emissive_metallic;	   // rgb in cd/m^2
	float scatter;			   // 0..1, see Material::scatter
	float scatter_distance_m;
	uint is_mirrored; // 1: the transform reverses the winding
	uint padding;
};
SHARED_SIZE(GBufferInstance, 112);

/// Transform of texture coordinates: dot(row_u.xyz, (u, v, 1)) and dot(row_v.xyz, (u, v, 1)) are
/// the coordinates in the image.
struct SHARED_ALIGN TextureTransform {
	vec4 row_u; // a: 1 = use the second texture coordinates of the mesh
	vec4 row_v; // a: unused
};
SHARED_SIZE(TextureTransform, 32);

/// What a material defines in addition to GBufferInstance.
struct SHARED_ALIGN MaterialConstants {
	TextureTransform base_color;
	TextureTransform metallic_roughness;
	TextureTransform normal;
	TextureTransform occlusion;
	TextureTransform emissive;
	float alpha;
	float alpha_cutoff; // fragments with a smaller alpha are discarded; -1: none
	float normal_scale;
	float occlusion_strength;
};
SHARED_SIZE(MaterialConstants, 176);

/// Push constants of ambient.comp and lighting.comp.
struct SHARED_ALIGN ExposurePush {
	vec4 ambient; // rgb: radiance of a white surface in ambient light, cd/m^2; a: exposure
};
SHARED_SIZE(ExposurePush, 16);

/// Push constants of tone_map.comp.
struct SHARED_ALIGN ToneMapPush {
	uint antialiasing; // texels per pixel along each axis, 1..4
	uint padding0;
	uint padding1;
	uint padding2;
};
SHARED_SIZE(ToneMapPush, 16);

/// Push constants of debug_view.comp.
struct SHARED_ALIGN DebugViewPush {
	vec2 shown_range; // value shown black, value shown white
	uint class_count; // above 0: values are classes 0 .. class_count - 1, shown in colours
	uint is_color;	  // 1: values are colours
};
SHARED_SIZE(DebugViewPush, 16);

/// Push constants of present.frag.
struct SHARED_ALIGN PresentPush {
	vec2 image_px_per_window_px;
	float padding0;
	float padding1;
};
SHARED_SIZE(PresentPush, 16);

#include "shared/shared_end.h"
#endif
