#pragma once

#include "modules/scene/scene_snapshot.h"

#include "shared/light_shared.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// A camera placed at the light. View space: x right, y down, z along the view, metres, origin at
/// the light (directional: at a point in front of all casters). Map space: see LightViewConstants.
struct LightView {
	glm::dmat4 view_from_world = glm::dmat4(1.0);
	bool is_orthographic = false;
	glm::vec2 half_extent = glm::vec2(1.0f); // tangents, or metres when orthographic
	float near_m = 0.001f;
	float far_m = 1.0f; // orthographic only; a perspective view reaches to infinity
	glm::uvec2 size_px = glm::uvec2(1024);
	/// Casters up to this distance outside the view's sides are listed too: geometry that a
	/// technique adds to them may reach into the view.
	float caster_margin_m = 0.0f;

	/// Vulkan clip space with reversed depth: 1 near .. 0 far.
	glm::dmat4 compute_clip_from_view() const;
	/// Computed in double precision, so that a scene far from the origin keeps its precision.
	glm::mat4 compute_clip_from_node(const glm::dmat4 &p_world_from_node) const;
	glm::mat4 compute_view_from_camera_relative(const CameraSnapshot &p_camera) const;
	shader::LightViewConstants compute_constants(
			const CameraSnapshot &p_camera, uint32_t p_layer) const;
	/// False only when the box, grown by caster_margin_m, is certainly outside the view's sides or
	/// behind it.
	bool may_see(const Bounds &p_bounds_world) const;
	/// As above, for bounds_world and also for the oriented box of the mesh that casts the
	/// instance's shadow (caster_bounds_node), which is tighter when the instance is rotated.
	bool may_see(const InstanceSnapshot &p_instance) const;
	/// Minimum and maximum distance of the box along the view in metres, negative behind the view.
	/// The box is not clipped to the view.
	glm::dvec2 compute_distance_range_m(const Bounds &p_bounds_world) const;
	/// As above, for the oriented box of the mesh that casts the instance's shadow.
	glm::dvec2 compute_distance_range_m(const InstanceSnapshot &p_instance) const;
	bool operator==(const LightView &) const = default;

private:
	/// may_see for a box in any space, grown by a margin on all sides.
	bool may_see_box(
			const Bounds &p_box, const glm::dmat4 &p_view_from_box, double p_margin_m) const;
};

/// A scene as a technique sees it for one light.
struct LightScene {
	const SceneSnapshot &scene;
	Bounds caster_bounds_world; // of the light's casters; empty when there are none

	LightScene(const SceneSnapshot &p_scene, const Bounds &p_caster_bounds_world) :
			scene(p_scene), caster_bounds_world(p_caster_bounds_world) {}
	/// With all casters of the scene.
	LightScene(const SceneSnapshot &p_scene) :
			LightScene(p_scene, p_scene.compute_caster_bounds()) {}
};

/// Views that together contain everything that can cast a shadow of the light: 1 for a spot with a
/// half angle up to 60 degrees and for a directional light, 6 for omni and wider spots (including
/// views that the cone misses, so that a view's index is its axis). Views of spot and omni lights
/// also contain all receivers that the light reaches. The view of a directional light is fitted to
/// the casters: a receiver outside of it reads an empty texel of the map's border, so it is lit.
/// Each view has a border of p_border_px texels around its content, so that a filter of that radius
/// stays in the map. p_caster_margin_m: how far a technique extends the casters, in metres; a
/// directional view contains the extended casters.
std::vector<LightView> build_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		uint32_t p_map_size_px, uint32_t p_border_px, float p_caster_margin_m = 0.0f);

/// The light in camera-relative space, as the shaders read it.
shader::LightConstants compute_light_constants(
		const LightSnapshot &p_light, const CameraSnapshot &p_camera);
/// Matrix from camera-relative space to the light's axes, for find_view in light_view_inc.glsl.
glm::mat4 compute_light_from_camera_relative(
		const LightSnapshot &p_light, const CameraSnapshot &p_camera);
/// All views of one light as the shaders read them.
shader::LightViewsConstants compute_light_views_constants(const LightSnapshot &p_light,
		const CameraSnapshot &p_camera, const std::vector<LightView> &p_views);

} // namespace gnomon
