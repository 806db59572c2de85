#pragma once

#include "modules/godot_addon/scenario_frame.h"
#include "modules/render_graph/render_graph.h"
#include "modules/rendering_device_godot/godot_device.h"
#include "modules/shadows/mesh_store.h"

namespace gnomon {

/// The view for which Godot calls a compositor effect: its buffers and its camera.
struct GodotView {
	godot::RID depth;
	/// Of `depth`. If there are several, the first one's depth is used, and the camera's rays pass
	/// through it.
	uint32_t sample_count = 1;
	bool has_depth_samples() const { return sample_count > 1; }
	godot::RID color;
	glm::uvec2 size_px = glm::uvec2(0);
	CameraSnapshot camera;
	godot::Transform3D camera_transform;
	float horizontal_scale = 1; // P[0][0] of the projection P
	float depth_offset = 0;		// P[2][2]
	bool is_orthogonal = false; // it has no masks
	/// Why no masks can be made for another view; empty: they can.
	std::string unsupported_reason;
};
/// p_buffers: the buffers of p_data.
GodotView read_view(GodotDevice &r_device, const godot::RenderData &p_data,
		const godot::RenderSceneBuffersRD &p_buffers);

/// Returns the settings of the view's viewport. Godot does not report which viewport it draws, so
/// it is identified by its camera's transform. If none matches, because Godot itself moved the
/// camera, those of the first viewport are returned.
ViewDetail find_view_detail(const ScenarioFrame &p_frame, const GodotView &p_view);

/// An instance that Godot draws with a reduced mesh, see detail_levels.h.
struct ReducedInstance {
	std::shared_ptr<const Mesh> full;			// the full mesh, posed
	std::shared_ptr<const Mesh> drawn;			// the reduced mesh; uses the vertices of full
	glm::mat4 clip_from_node = glm::mat4(1.0f); // reversed depth: near / z
};
struct ReducedInstances {
	std::vector<ReducedInstance> list;
	/// Largest deviation from its full mesh that a reduced mesh may have, as a fraction of the
	/// distance.
	float lod_tolerance = 0;
};
/// Returns the reduced instances that may be visible. p_scene must have the view's camera.
ReducedInstances find_reduced_instances(const ScenarioFrame &p_frame, const SceneSnapshot &p_scene,
		const GodotView &p_view, const ViewDetail &p_detail);

/// Adds passes that compute the depth for shadows, near / z, with the full meshes instead of the
/// reduced ones, where the rays of the view's camera meet them. p_depth: Godot's depth. Call it
/// after the pass that deforms meshes was added.
///
/// p_published: gets the depth of the surfaces that Godot draws, for materials; may be empty unless
/// the view is multisampled.
RGTexture add_view_depth(RenderGraph &r_graph, MeshStore &r_meshes, const GodotView &p_view,
		RGTexture p_depth, std::shared_ptr<const ReducedInstances> p_reduced,
		RGTexture p_published);

} // namespace gnomon
