#include "modules/scene/stage.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/scene/box_mesh.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace gnomon {

namespace {

const double CAMERA_FOV_RAD = 0.64;
const double CAMERA_MARGIN = 1.12; // 1: the framed points touch the sides of the image
// Direction to the camera: from the front, which faces +z, slightly from the left and from above.
const glm::dvec3 TO_CAMERA(-0.5, 0.45, 1.0);
// Direction to the light: over the camera's other shoulder, so that the shadow falls where it is
// visible.
const glm::dvec3 TO_LIGHT(0.75, 1.6, 0.7);
// Lengths in diagonals of the meshes' bounds. No technique needs casters farther than 5 radii from
// the light (ShadowLimits): 1.5 for the largest light of a report, of radius 0.3. Corners can be
// 0.5 nearer than the centre.
const double LIGHT_DISTANCE = 2.2;
const double LIGHT_SIZE = 0.1; // radius
const double GROUND_HALF_WIDTH = 6.0;
const double GROUND_HALF_HEIGHT = 0.05;
const double GROUND_GAP = 1e-3; // below the meshes, because coplanar faces would flicker

Bounds compute_bounds(const Scene &p_scene) {
	Bounds bounds;
	for (const MeshInstance3D *instance : p_scene.find_nodes<MeshInstance3D>()) {
		const Bounds own = instance->compute_bounds();
		if (!own.is_empty()) {
			bounds.add(own);
		}
	}
	return bounds;
}

glm::dmat4 look_at(const glm::dvec3 &p_from, const glm::dvec3 &p_to) {
	return glm::inverse(glm::lookAt(p_from, p_to, glm::dvec3(0, 1, 0)));
}

/// Returns where a light's shadow of the point falls on the plane y = p_ground_y, below both.
glm::dvec3 project_to_ground(
		const glm::dvec3 &p_point, const glm::dvec3 &p_light, double p_ground_y) {
	return glm::mix(p_light, p_point, (p_light.y - p_ground_y) / (p_light.y - p_point.y));
}

/// Returns the nearest position from which an image, or the central square of a wide one, shows all
/// points with the margin, for a camera that looks along -TO_CAMERA and whose up direction is y.
glm::dvec3 find_camera_position(const std::vector<glm::dvec3> &p_points, double p_aspect) {
	const glm::dmat3 world_from_view(look_at(TO_CAMERA, glm::dvec3(0.0)));
	const glm::dvec2 slope =
			std::tan(CAMERA_FOV_RAD / 2) / CAMERA_MARGIN * glm::dvec2(std::min(p_aspect, 1.0), 1.0);
	// A point is visible if |x - position.x| <= slope.x * (position.z - z), and the same for y. It
	// bounds position.x + slope.x * position.z from below and position.x - slope.x * position.z
	// from above.
	glm::dvec2 lower(-std::numeric_limits<double>::infinity());
	glm::dvec2 upper(std::numeric_limits<double>::infinity());
	for (const glm::dvec3 &point : p_points) {
		const glm::dvec3 view = glm::transpose(world_from_view) * point;
		lower = glm::max(lower, glm::dvec2(view) + slope * view.z);
		upper = glm::min(upper, glm::dvec2(view) - slope * view.z);
	}
	const glm::dvec2 z = (lower - upper) / (2.0 * slope);
	return world_from_view * glm::dvec3(0.5 * (lower + upper), std::max(z.x, z.y));
}

/// Returns a name that no node of the scene has.
std::string choose_name(const Scene &p_scene, const std::string &p_requested) {
	std::set<std::string> taken;
	for (const Node3D *node : p_scene.find_nodes<Node3D>()) {
		taken.insert(node->name);
	}
	std::string name = p_requested;
	for (int number = 2; taken.contains(name); ++number) {
		name = text(p_requested, "_", number);
	}
	return name;
}

void add_first(Scene &r_scene, std::unique_ptr<Node3D> p_node, const std::string &p_name) {
	p_node->name = choose_name(r_scene, p_name);
	p_node->is_staged = true;
	r_scene.root->insert_child(std::move(p_node), 0);
}

} // namespace

StageMode parse_stage_mode(const std::string &p_text, const std::string &p_object) {
	if (p_text == "auto") {
		return StageMode::AUTO;
	}
	if (p_text == "on" || p_text == "off") {
		return p_text == "on" ? StageMode::ON : StageMode::OFF;
	}
	fail(p_object, " is \"", p_text, "\", must be auto, on or off.");
}

const char *get_stage_mode_name(StageMode p_mode) {
	return p_mode == StageMode::AUTO ? "auto" : p_mode == StageMode::ON ? "on" : "off";
}

std::string stage_scene(Scene &r_scene, StageMode p_mode, double p_aspect) {
	const Bounds bounds = compute_bounds(r_scene);
	const double size_m = bounds.get_diagonal();
	if (p_mode == StageMode::OFF || !(size_m > 0) || !std::isfinite(size_m)) {
		return "";
	}
	const bool adds_all = p_mode == StageMode::ON;
	const bool needs_camera = adds_all || r_scene.find_nodes<Camera3D>().empty();
	const bool needs_light = adds_all || r_scene.find_nodes<Light3D>().empty();
	const glm::dvec3 centre = 0.5 * (bounds.minimum + bounds.maximum);
	std::vector<glm::dvec3> framed; // relative to the centre, which may be far from the origin
	for (int corner = 0; corner < 8; ++corner) {
		framed.push_back(bounds.get_corner(corner) - centre);
	}
	std::string added;
	if (needs_light) {
		auto ground = std::make_unique<MeshInstance3D>();
		const double below = size_m * (GROUND_GAP + GROUND_HALF_HEIGHT);
		ground->parent_from_node = glm::translate(
				glm::dmat4(1.0), glm::dvec3(centre.x, bounds.minimum.y - below, centre.z));
		ground->surfaces.push_back(
				{ make_box_mesh("stage ground",
						  glm::vec3(size_m *
								  glm::dvec3(GROUND_HALF_WIDTH, GROUND_HALF_HEIGHT,
										  GROUND_HALF_WIDTH))),
						std::make_shared<const Material>() });
		ground->casts_shadow = false;
		ground->is_planar_receiver = true;
		add_first(r_scene, std::move(ground), "Stage ground");

		auto light = std::make_unique<Light3D>();
		light->type = LightType::SPOT;
		const glm::dvec3 to_light = glm::normalize(TO_LIGHT) * (LIGHT_DISTANCE * size_m);
		light->parent_from_node = look_at(centre + to_light, centre);
		for (int corner = 0; corner < 8; ++corner) {
			framed.push_back(
					project_to_ground(framed[corner], to_light, bounds.minimum.y - centre.y));
		}
		// Half angles; the sphere around the meshes' bounds has asin(0.5 / LIGHT_DISTANCE) = 0.23.
		light->inner_cone_rad = 0.5f;
		light->outer_cone_rad = 0.8f;
		// The illuminance of the meshes, 1200 / LIGHT_DISTANCE^2 = 250 lx, does not depend on their
		// size.
		light->intensity = static_cast<float>(1200.0 * std::max(size_m * size_m, 1e-6));
		light->properties["light_size"] = std::min(LIGHT_SIZE * size_m, MAX_LENGTH_M);
		add_first(r_scene, std::move(light), "Stage light");
		added = "a spot light and a ground";
	}
	if (needs_camera) {
		auto camera = std::make_unique<Camera3D>();
		const glm::dvec3 to_camera = find_camera_position(framed, p_aspect);
		camera->parent_from_node =
				look_at(centre + to_camera, centre + to_camera - size_m * TO_CAMERA);
		camera->vertical_fov_rad = static_cast<float>(CAMERA_FOV_RAD);
		camera->near_m = static_cast<float>(1e-3 * glm::length(to_camera));
		add_first(r_scene, std::move(camera), "Stage camera");
		added = added.empty() ? "a camera" : "a camera, " + added;
	}
	return added.empty() ? ""
						 : text("Staged: ", added, added == "a camera" ? " was" : " were",
								   " added. The file stays as it is.");
}

} // namespace gnomon
