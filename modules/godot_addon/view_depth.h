#pragma once

#include "modules/godot_addon/scenario_frame.h"
#include "modules/render_graph/render_graph.h"
#include "modules/rendering_device_godot/godot_device.h"
#include "modules/shadows/mesh_store.h"

namespace gnomon {

/// What Godot has drawn of a view when it calls an effect.
struct GodotView {
	godot::RID depth;
	godot::RID color;
	glm::uvec2 size_px = glm::uvec2(0);
	CameraSnapshot camera;
	godot::Transform3D camera_transform;
	float horizontal_scale = 1; // P[0][0]
	float depth_offset = 0;		// P[2][2] of its projection P
	/// Why masks cannot be made for it; empty: they can.
	std::string refusal;
};
/// p_buffers: of p_data.
GodotView read_view(const godot::RenderData &p_data, const godot::RenderSceneBuffersRD &p_buffers);

/// An instance that Godot draws with fewer triangles.
struct ReducedInstance {
	std::shared_ptr<const Mesh> full;			// as posed
	std::shared_ptr<const Mesh> drawn;			// its triangles are of the full one's vertices
	glm::mat4 clip_from_node = glm::mat4(1.0f); // reversed depth: near / z
};
struct ReducedInstances {
	std::vector<ReducedInstance> list;
	/// What a deviation of one of them may be of its distance.
	float most_share = 0;
};
/// Those that the view may see. p_scene: with the view's camera.
ReducedInstances find_reduced_instances(
		const ScenarioFrame &p_frame, const SceneSnapshot &p_scene, const GodotView &p_view);

/// The depth as shadows read it, near / z, of the full meshes. p_depth: Godot's. After the pass
/// that deforms meshes.
RGTexture add_view_depth(RenderGraph &r_graph, MeshStore &r_meshes, const GodotView &p_view,
		RGTexture p_depth, std::shared_ptr<const ReducedInstances> p_reduced);

} // namespace gnomon
