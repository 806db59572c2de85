#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/renderer/material_store.h"
#include "modules/scene/scene_snapshot.h"
#include "modules/shadows/mesh_store.h"
#include "modules/shadows/visible_receivers.h"

#include "renderer/renderer_shared.h"

#include <span>
#include <vector>

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

/// The instances of a snapshot that the camera may see. Those with one mesh, and one material if it
/// has textures, are a group, which is one draw.
struct GBufferInstances {
	struct Group {
		uint32_t scene_instance = 0; // the first of them, in the snapshot
		uint32_t first = 0;			 // in `instances`
		uint32_t count = 0;
	};
	SharedVector<InstanceSnapshot> scene_instances; // of the snapshot
	uint64_t camera_hash = 0;
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<Group> groups; // in the order of their first instances
	std::vector<shader::GBufferInstance> instances;

	/// Whether collect_gbuffer_instances would return the same.
	bool is_of(const SceneSnapshot &p_scene, glm::uvec2 p_size_px) const {
		return scene_instances.shares_items_with(p_scene.instances) &&
				camera_hash == p_scene.camera.compute_hash(0) && size_px == p_size_px;
	}
};

/// p_visible: from ShadowFrame::list_visible. p_size_px: of the image.
GBufferInstances collect_gbuffer_instances(const SceneSnapshot &p_scene,
		std::span<const VisibleReceiver> p_visible, glm::uvec2 p_size_px);

/// Draws the instances.
GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &r_meshes,
		MaterialStore &r_materials, const GBufferInstances &p_instances, RGBuffer p_frame);

} // namespace gnomon
