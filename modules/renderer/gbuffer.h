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
	std::vector<uint32_t> places; // by instance of the snapshot: where in `instances`, or NOT_DRAWN
	static constexpr uint32_t NOT_DRAWN = ~0u;

	/// Makes this the instances of a snapshot. If the camera is still, it makes only those that
	/// have changed. p_visible: from ShadowFrame::list_visible. p_size_px: of the image.
	void update(const SceneSnapshot &p_scene, std::span<const VisibleReceiver> p_visible,
			glm::uvec2 p_size_px);

private:
	void collect(const SceneSnapshot &p_scene, std::span<const VisibleReceiver> p_visible,
			const LightView &p_camera_view);
	/// Returns false if others than before are drawn, or in other groups.
	bool move(const SceneSnapshot &p_scene, std::span<const VisibleReceiver> p_visible,
			const LightView &p_camera_view);
};

/// Draws the instances.
GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &r_meshes,
		MaterialStore &r_materials, const GBufferInstances &p_instances, RGBuffer p_frame);

} // namespace gnomon
