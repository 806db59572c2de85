#pragma once

#include "modules/scene/box_mesh.h"
#include "modules/scene/nodes.h"
#include "modules/stability_report/stability_bodies.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace gnomon {

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
	/// Unit, from the target to the light.
	glm::dvec3 get_way_to_light() const {
		return (light_position - light_target) / get_distance_m();
	}
	/// Only the ground stays.
	void clear_casters() { bodies.resize(1); }
	StabilityBody &add_box(const char *p_name, const glm::dvec3 &p_center,
			const glm::vec3 &p_half_size_m, double p_turn_rad = 0.0) {
		bodies.push_back({ p_name, make_box_mesh(p_name, p_half_size_m),
				glm::rotate(glm::translate(glm::dmat4(1.0), p_center), p_turn_rad,
						glm::dvec3(0, 1, 0)) });
		return bodies.back();
	}
	void add_mesh(
			const char *p_name, std::shared_ptr<const Mesh> p_mesh, const glm::dvec3 &p_center) {
		bodies.push_back({ p_name, std::move(p_mesh), glm::translate(glm::dmat4(1.0), p_center) });
	}
};

/// Makes the draft the hostile scene of that index, see get_guard_names().
void change_to_guard(StabilityDraft &r_draft, size_t p_index);

} // namespace gnomon
