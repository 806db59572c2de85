#include "modules/error_report/scaling_scenes.h"

#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/scene/box_mesh.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace gnomon {

namespace {

// Dimensions of the scene torus_knot as demo_project/scenes/make_scenes.py builds it, in metres.
const double KNOT_SCALE_M = 0.36;
const glm::dvec3 KNOT_CENTER(0.0, 1.4, 0.0);
const double TUBE_RADIUS_M = 0.16;
const double ALONG_TO_AROUND_RATIO = 500.0 / 30.0; // quads along the tube per quad around it
const uint32_t GROUND_TRIANGLE_COUNT = 12;
const glm::vec3 GROUND_HALF_SIZE_M(4.2f, 0.2f, 4.2f);
const glm::dvec3 LIGHT_POSITION(1.8, 6.0, 1.2);
const glm::dvec3 LIGHT_TARGET(0.0, 0.4, 0.0);
const double LIGHT_CONE_TANGENT = 0.95;	 // tangent of half the cone's angle
const float TOTAL_INTENSITY_CD = 500.0f; // of all lights together
const glm::dvec3 CAMERA_POSITION(-3.2, 4.6, 4.6);
const glm::dvec3 CAMERA_TARGET(-0.3, 0.45, -0.2);
const double CAMERA_FOV_RAD = 0.64350110879; // vertical, 36.87 degrees

/// Returns a point on the knot's centre line, a (2, 3) torus knot. p_fraction: position along the
/// line, period 1.
glm::dvec3 compute_knot_point(double p_fraction) {
	const double t = p_fraction * 2.0 * std::numbers::pi;
	const double ring = 2.0 + std::cos(3.0 * t);
	return KNOT_CENTER +
			KNOT_SCALE_M *
			glm::dvec3(ring * std::cos(2.0 * t), -std::sin(3.0 * t), ring * std::sin(2.0 * t));
}

std::shared_ptr<const Mesh> make_knot(uint32_t p_triangle_count) {
	// A quad has two triangles.
	const double around = std::sqrt(p_triangle_count * 0.5 / ALONG_TO_AROUND_RATIO);
	const uint32_t around_count = std::max(3u, static_cast<uint32_t>(std::lround(around)));
	const uint32_t along_count =
			std::max(3u, static_cast<uint32_t>(std::lround(p_triangle_count * 0.5 / around_count)));
	std::vector<glm::vec3> positions;
	std::vector<uint32_t> indices;
	for (uint32_t along = 0; along < along_count; ++along) {
		const double fraction = double(along) / along_count;
		const glm::dvec3 center = compute_knot_point(fraction);
		const glm::dvec3 forward = glm::normalize(
				compute_knot_point(fraction + 1e-4) - compute_knot_point(fraction - 1e-4));
		const glm::dvec3 side = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
		const glm::dvec3 up = glm::cross(side, forward);
		for (uint32_t step = 0; step < around_count; ++step) {
			const double angle = 2.0 * std::numbers::pi * step / around_count;
			positions.push_back(glm::vec3(
					center + TUBE_RADIUS_M * (std::cos(angle) * side + std::sin(angle) * up)));
			const uint32_t next_along = (along + 1) % along_count;
			const uint32_t next_step = (step + 1) % around_count;
			const uint32_t a = along * around_count + step;
			const uint32_t b = next_along * around_count + step;
			const uint32_t c = next_along * around_count + next_step;
			const uint32_t d = along * around_count + next_step;
			indices.insert(indices.end(), { a, b, c, a, c, d });
		}
	}
	return make_mesh("knot", std::move(positions), {}, std::move(indices));
}

/// Returns world_from_node of a node at p_position that looks along -Z at p_target.
glm::dmat4 look_at(const glm::dvec3 &p_position, const glm::dvec3 &p_target) {
	return glm::inverse(glm::lookAtRH(p_position, p_target, glm::dvec3(0, 1, 0)));
}

void add_lights(Node3D &r_root, const ScalingScene &p_description) {
	const double radius_m = std::hypot(LIGHT_POSITION.x, LIGHT_POSITION.z);
	const double first_rad = std::atan2(LIGHT_POSITION.z, LIGHT_POSITION.x);
	for (uint32_t index = 0; index < p_description.light_count; ++index) {
		const double angle = first_rad + 2.0 * std::numbers::pi * index / p_description.light_count;
		const glm::dvec3 position(
				radius_m * std::cos(angle), LIGHT_POSITION.y, radius_m * std::sin(angle));
		auto light = std::make_unique<Light3D>();
		light->name = text("Light ", index + 1);
		light->type = LightType::SPOT;
		light->intensity = TOTAL_INTENSITY_CD / float(p_description.light_count);
		light->outer_cone_rad = static_cast<float>(std::atan(LIGHT_CONE_TANGENT));
		light->properties["light_size"] = p_description.light_size_m;
		light->parent_from_node = look_at(position, LIGHT_TARGET);
		r_root.add_child(std::move(light));
	}
}

/// Indexed by ReportExtent.
const std::vector<ScalingSeries> SERIES[] = {
	{},
	{ { TRIANGLES_GROUP, { 2000, 30000, 120000 } }, { LIGHT_SIZE_GROUP, { 0.08, 0.4, 1.2 } },
			{ LIGHTS_GROUP, { 1, 3, 8 } }, { RESOLUTION_GROUP, { 128, 256, 512 } } },
	{ { TRIANGLES_GROUP, { 2000, 8000, 30000, 120000, 500000, 1000000 } },
			{ LIGHT_SIZE_GROUP, { 0.02, 0.08, 0.4, 1.2, 2.4 } }, { LIGHTS_GROUP, { 1, 4, 16, 64 } },
			{ RESOLUTION_GROUP, { 128, 256, 512, 1024, 2048 } } },
};

} // namespace

ReportExtent parse_extent(std::string_view p_name) {
	const auto found = std::ranges::find(EXTENT_NAMES, p_name);
	GNOMON_ASSERT(found != std::end(EXTENT_NAMES), p_name, " is no extent of a report");
	return static_cast<ReportExtent>(found - EXTENT_NAMES);
}

const std::vector<ScalingSeries> &get_scaling_series(ReportExtent p_extent) {
	return SERIES[static_cast<int>(p_extent)];
}

std::unique_ptr<Scene> make_scaling_scene(const ScalingScene &p_description) {
	auto scene = std::make_unique<Scene>();
	scene->scene_size_m = 4.0;
	const uint32_t knot_count = p_description.triangle_count - GROUND_TRIANGLE_COUNT;
	for (const std::shared_ptr<const Mesh> &mesh :
			{ make_knot(knot_count), make_box_mesh("ground", GROUND_HALF_SIZE_M) }) {
		auto instance = std::make_unique<MeshInstance3D>();
		instance->name = mesh->name;
		instance->surfaces.push_back({ mesh, nullptr });
		if (mesh->name == "ground") { // its top is at 0
			instance->parent_from_node[3].y = -GROUND_HALF_SIZE_M.y;
		}
		scene->root->add_child(std::move(instance));
	}
	add_lights(*scene->root, p_description);
	auto camera = std::make_unique<Camera3D>();
	camera->name = "Camera";
	camera->vertical_fov_rad = static_cast<float>(CAMERA_FOV_RAD);
	camera->parent_from_node = look_at(CAMERA_POSITION, CAMERA_TARGET);
	scene->root->add_child(std::move(camera));
	return scene;
}

} // namespace gnomon
