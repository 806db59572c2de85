#pragma once

#include "modules/scene/box_mesh.h"
#include "modules/scene/nodes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// A caster or receiver of a stability scene.
struct StabilityBody {
	std::string name;
	std::shared_ptr<const Mesh> mesh;
	glm::dmat4 world_from_node = glm::dmat4(1.0);
	bool casts_shadow = true;
};

/// Description of a generated scene of the stability sweeps. The poses of light and camera are by
/// default those of the demo scenes; each sweep changes some of the values. bodies[0] is the
/// ground. Lengths are in metres, before `scale`.
struct StabilityDraft {
	static constexpr double SCENE_SIZE_M = 4.0;
	static constexpr glm::dvec3 LIGHT_POSITION = { 1.8, 6.0, 1.2 };
	static constexpr glm::dvec3 LIGHT_TARGET = { 0.0, 0.4, 0.0 };
	static constexpr glm::dvec3 CAMERA_TARGET = { -0.3, 0.45, -0.2 };
	static constexpr double LIGHT_SIZE_PER_SCENE_SIZE = 0.05; // light radius R as a fraction of S

	double light_size_m = LIGHT_SIZE_PER_SCENE_SIZE * SCENE_SIZE_M;
	glm::dvec3 light_position = LIGHT_POSITION;
	glm::dvec3 light_target = LIGHT_TARGET;
	double cone_rad = std::atan(0.95); // half angle of a spot light, also as in the demo scenes
	glm::dvec3 camera_target = CAMERA_TARGET;
	PropertyValues properties; // additional properties of the light
	std::vector<StabilityBody> bodies;
	double scale = 1.0;					   // factor of all lengths
	glm::dvec3 offset_m = glm::dvec3(0.0); // translation of the scaled scene

	/// Distance from the light to its target.
	double get_distance_m() const { return glm::length(light_target - light_position); }
	/// Removes all bodies but the ground.
	void clear_casters() { bodies.resize(1); }
	void add_box(const char *p_name, const glm::vec3 &p_half_size_m,
			const glm::dmat4 &p_world_from_node) {
		bodies.push_back({ p_name, make_box_mesh(p_name, p_half_size_m), p_world_from_node });
	}
	void add_box(const char *p_name, const glm::dvec3 &p_center, const glm::vec3 &p_half_size_m,
			double p_yaw_rad = 0.0) {
		add_box(p_name, p_half_size_m,
				glm::rotate(
						glm::translate(glm::dmat4(1.0), p_center), p_yaw_rad, glm::dvec3(0, 1, 0)));
	}
	void add_mesh(
			const char *p_name, std::shared_ptr<const Mesh> p_mesh, const glm::dvec3 &p_center) {
		bodies.push_back({ p_name, std::move(p_mesh), glm::translate(glm::dmat4(1.0), p_center) });
	}
};

/// Returns a closed sphere of 320 triangles.
std::shared_ptr<const Mesh> make_sphere_mesh(double p_radius_m);
/// Returns a closed cube. Two cuts divide each face into four rectangles of two triangles. The cuts
/// are parallel to two of the face's edges, at the same distance, which leaves narrow strips.
/// p_aspect_ratio: length of a whole strip divided by its width; up to 2 the cuts are in the middle
/// of the face.
std::shared_ptr<const Mesh> make_cut_box(double p_half_size_m, double p_aspect_ratio);
/// Returns a closed cube with inverted winding: its faces point inwards.
std::shared_ptr<const Mesh> make_inside_out_box(double p_half_size_m);
/// Returns a mesh of a single, slightly tilted triangle.
std::shared_ptr<const Mesh> make_open_mesh();
/// Returns a mesh made from triangles of zero area, slivers, coincident faces, and normals of
/// length 0, which make_mesh replaces.
std::shared_ptr<const Mesh> make_degenerate_mesh();

/// Changes the draft to the hostile scene with that index in list_hostile_scene_names().
void change_to_hostile_scene(StabilityDraft &r_draft, size_t p_index);

} // namespace gnomon
