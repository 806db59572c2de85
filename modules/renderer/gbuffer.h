#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/renderer/material_store.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/mesh_store.h"

namespace gnomon {

/// The geometry that the camera sees, one texel per pixel.
struct GBuffer {
	RGTexture depth;			// D32_SFLOAT, reversed: 0 is the background
	RGTexture base_color;		// RGBA8_SRGB; alpha: ambient occlusion, 1 = unoccluded
	RGTexture geometric_normal; // R32_UINT; empty without DeviceFeatures::geometry_shader
	RGTexture shading_normal;	// R32_UINT; normals are packed, see normal_inc.glsl
	RGTexture material;			// RGBA16_SFLOAT: scatter, scatter_distance_m, roughness
								// (-1 - roughness for Phong's model), metallic
	RGTexture emissive;			// RGBA16_SFLOAT, cd/m^2
};

/// Draws the instances that may be in the camera's view. r_drawn_count: their number.
GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &r_meshes,
		MaterialStore &r_materials, const SceneSnapshot &p_scene, glm::uvec2 p_size_px,
		RGBuffer p_frame, uint32_t &r_drawn_count);

} // namespace gnomon
