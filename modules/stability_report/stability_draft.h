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

/// What a scene of the stability sweeps is made from; the start of all, as the demo scenes have it.
struct StabilityDraft {
	static constexpr double SCENE_SIZE_M = 4.0;
	static constexpr glm::dvec3 LIGHT_POSITION = { 1.8, 6.0, 1.2 };
	static constexpr glm::dvec3 LIGHT_TARGET = { 0.0, 0.4, 0.0 };
	static constexpr glm::dvec3 CAMERA_TARGET = { -0.3, 0.45, -0.2 };
	static constexpr double LIGHT_SIZE_SIZES = 0.05;

	double light_size_m = LIGHT_SIZE_SIZES * SCENE_SIZE_M;
	glm::dvec3 light_position = LIGHT_POSITION;
	glm::dvec3 light_target = LIGHT_TARGET;
	double cone_rad = std::atan(0.95);
	glm::dvec3 camera_target = CAMERA_TARGET;
	PropertyValues properties;
	std::vector<StabilityBody> bodies;
	double scale = 1.0;
	glm::dvec3 offset_m = glm::dvec3(0.0);

	double get_distance_m() const { return glm::length(light_target - light_position); }
	/// Only the ground stays.
	void clear_casters() { bodies.resize(1); }
	void add_box(const char *p_name, const glm::vec3 &p_half_size_m,
			const glm::dmat4 &p_world_from_node) {
		bodies.push_back({ p_name, make_box_mesh(p_name, p_half_size_m), p_world_from_node });
	}
	void add_box(const char *p_name, const glm::dvec3 &p_center, const glm::vec3 &p_half_size_m,
			double p_turn_rad = 0.0) {
		add_box(p_name, p_half_size_m,
				glm::rotate(glm::translate(glm::dmat4(1.0), p_center), p_turn_rad,
						glm::dvec3(0, 1, 0)));
	}
	void add_mesh(
			const char *p_name, std::shared_ptr<const Mesh> p_mesh, const glm::dvec3 &p_center) {
		bodies.push_back({ p_name, std::move(p_mesh), glm::translate(glm::dmat4(1.0), p_center) });
	}
};

/// A closed sphere of 320 triangles.
std::shared_ptr<const Mesh> make_globe(double p_radius_m);
/// A closed cube each of whose faces is cut next to one of its edges, so that the strip's triangles
/// have this ratio of length to width; at 1 in the middle.
std::shared_ptr<const Mesh> make_cut_box(double p_half_size_m, double p_aspect_ratio);
/// A closed box whose faces look inwards.
std::shared_ptr<const Mesh> make_turned_box(double p_half_size_m);
/// One leaning triangle without thickness.
std::shared_ptr<const Mesh> make_open_mesh();
/// Triangles of no area, slivers, faces that coincide, and normals of length 0.
std::shared_ptr<const Mesh> make_odd_mesh();

/// Makes the draft the hostile scene of that index, see list_guard_names().
void change_to_guard(StabilityDraft &r_draft, size_t p_index);

} // namespace gnomon
