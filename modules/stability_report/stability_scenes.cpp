#include "modules/stability_report/stability_scenes.h"

#include "modules/core/error.h"
#include "modules/stability_report/stability_draft.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <functional>
#include <map>

namespace gnomon {

namespace {

// The camera of the demo scenes; positions in metres.
const glm::dvec3 CAMERA_POSITION(-3.2, 4.6, 4.6);
const double CAMERA_FOV_RAD = 0.64350110879;			// 36.87 degrees
const double MAX_LIGHT_DEGREES = 90.0;					// apparent diameter, directional
const glm::dvec3 OFFSET_DIRECTION(0.64, -0.192, 0.744); // unit length, not along an axis

/// Returns world_from_node of a node at p_position that looks along -Z at p_target.
glm::dmat4 look_at(const glm::dvec3 &p_position, const glm::dvec3 &p_target) {
	const glm::dvec3 direction = glm::normalize(p_target - p_position);
	const glm::dvec3 up = std::abs(direction.y) < 0.999 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
	return glm::inverse(glm::lookAtRH(p_position, p_target, up));
}

/// Returns the scene that make_stability_scene changes: a ground, a floating box, a floating sphere
/// and a box in contact with the ground.
StabilityDraft make_start() {
	StabilityDraft draft;
	draft.add_box("ground", { 0, -0.2, 0 }, { 4.2f, 0.2f, 4.2f });
	draft.add_box("block", { 0.2, 0.9, 0.1 }, { 0.35f, 0.25f, 0.35f }, 0.4);
	draft.add_mesh("globe", make_sphere_mesh(0.35), { -0.8, 0.9, -0.4 });
	draft.add_box("post", { -0.5, 0.35, 0.7 }, { 0.12f, 0.4f, 0.12f }, 0.2);
	return draft;
}

// One function per sweep, which changes the start scene. The second argument is the value of the
// sweep; StabilitySweep::quantity states its unit.

/// A single caster near the light. p_value: the light's distance to its target divided by its
/// distance to the caster. The caster and the light's radius scale with the latter, so that the
/// shadow on the target hardly changes, and only the range of depths does.
void change_depth_range(StabilityDraft &r_draft, double p_value) {
	r_draft.clear_casters();
	const double near_m = r_draft.get_distance_m() / p_value;
	r_draft.light_size_m = 0.02 * near_m;
	const glm::dmat4 at_light = look_at(r_draft.light_position, r_draft.light_target);
	r_draft.add_box("near", glm::vec3(0.08f, 0.06f, 0.01f),
			glm::scale(glm::translate(at_light, glm::dvec3(0, 0, -near_m)), glm::dvec3(near_m)));
}

/// Adds a plate in front of the light, slightly to the side. p_radii: distance of the plate's
/// nearest face from the light, in light radii R.
void change_near_caster(StabilityDraft &r_draft, double p_radii) {
	const glm::dmat4 at_light = look_at(r_draft.light_position, r_draft.light_target);
	r_draft.add_box("near", glm::vec3(0.12f, 0.1f, 0.01f),
			glm::translate(
					at_light, glm::dvec3(0.1, 0.05, -p_radii * r_draft.light_size_m - 0.01)));
}

/// p_degrees: angle between the ground's normal and the direction to the light.
void change_slope(StabilityDraft &r_draft, double p_degrees) {
	const double angle = glm::radians(p_degrees);
	r_draft.light_target = glm::dvec3(0.0);
	// 6.3 m from the target. (0.83, 0, 0.5578) has unit length and, seen from above, is almost the
	// direction from which the light shines in the other sweeps.
	r_draft.light_position = 6.3 *
			(std::sin(angle) * glm::dvec3(0.83, 0, 0.5578) + std::cos(angle) * glm::dvec3(0, 1, 0));
	r_draft.clear_casters();
	r_draft.add_box("post", { 0.3, 0.25, 0.2 }, { 0.25f, 0.3f, 0.2f }, 0.4);
}

/// A rod whose axis points almost at the light. p_degrees: angle between the two.
void change_end_on(StabilityDraft &r_draft, double p_degrees) {
	r_draft.clear_casters();
	const glm::dvec3 center(0.0, 1.4, 0.0);
	// The direction to the light, which is not the axis of its cone.
	r_draft.add_box("rod", glm::vec3(0.06f, 0.05f, 0.7f),
			glm::rotate(look_at(center, r_draft.light_position), glm::radians(p_degrees),
					glm::dvec3(0, 1, 0)));
}

/// A stack of p_count thin plates, each moved and rotated a little.
void change_layers(StabilityDraft &r_draft, double p_count) {
	r_draft.clear_casters();
	for (int index = 0; index < int(p_count); ++index) {
		const double height = 0.5 + 2.4 * index / p_count;
		r_draft.add_box("plate", { 0.05 * std::sin(1.7 * index), height, 0.05 * std::cos(index) },
				{ 0.5f, 0.008f, 0.4f }, 0.13 * index);
	}
}

/// A cube behind the light, as seen from the light's target. p_scene_sizes: distance from the light
/// to the cube's nearest face, in S; below 0 the light is inside the cube.
void change_inside(StabilityDraft &r_draft, double p_scene_sizes) {
	r_draft.clear_casters();
	const float half = 0.5f;
	r_draft.add_box("around", glm::vec3(half),
			glm::translate(look_at(r_draft.light_position, r_draft.light_target),
					glm::dvec3(0.1, 0.05, half + p_scene_sizes * StabilityDraft::SCENE_SIZE_M)));
	r_draft.add_box("block", { 0.2, 0.9, 0.1 }, { 0.35f, 0.25f, 0.35f }, 0.4);
}

using Change = std::function<void(StabilityDraft &, double)>;

const std::map<std::string, Change> &get_changes() {
	static const std::map<std::string, Change> CHANGES = {
		{ "light_size",
				[](StabilityDraft &r_draft, double p_scene_sizes) {
					r_draft.light_size_m = p_scene_sizes * StabilityDraft::SCENE_SIZE_M;
				} },
		{ "depth_range", change_depth_range },
		{ "near_caster", change_near_caster },
		{ "scale", [](StabilityDraft &r_draft, double p_scale) { r_draft.scale = p_scale; } },
		{ "offset",
				[](StabilityDraft &r_draft, double p_metres) {
					r_draft.offset_m = p_metres * OFFSET_DIRECTION;
				} },
		{ "slope", change_slope },
		{ "gap",
				[](StabilityDraft &r_draft, double p_scene_sizes) {
					r_draft.clear_casters();
					r_draft.add_box("block",
							{ 0.2, 0.25 + p_scene_sizes * StabilityDraft::SCENE_SIZE_M, 0.1 },
							{ 0.35f, 0.25f, 0.35f }, 0.4);
				} },
		{ "thickness",
				[](StabilityDraft &r_draft, double p_scene_sizes) {
					r_draft.clear_casters();
					r_draft.add_box("plate", { 0, 0.8, 0 },
							{ 0.6f, float(0.5 * p_scene_sizes * StabilityDraft::SCENE_SIZE_M),
									0.5f },
							0.4);
				} },
		{ "aspect",
				[](StabilityDraft &r_draft, double p_ratio) {
					r_draft.clear_casters();
					r_draft.add_mesh("cut box", make_cut_box(0.5, p_ratio), { 0, 0.9, 0 });
				} },
		{ "end_on", change_end_on },
		{ "layers", change_layers },
		{ "fin_width",
				[](StabilityDraft &r_draft, double p_scene_sizes) {
					r_draft.properties["penumbra_outer_width"] =
							p_scene_sizes * StabilityDraft::SCENE_SIZE_M;
					r_draft.properties["penumbra_inner_width"] =
							p_scene_sizes * StabilityDraft::SCENE_SIZE_M;
				} },
		{ "inside", change_inside },
	};
	return CHANGES;
}

/// Builds the scene of a draft, with one light of type p_type.
std::unique_ptr<Scene> build_scene(const StabilityDraft &p_draft, LightType p_type) {
	const double scale = p_draft.scale;
	const auto transform_point = [&](const glm::dvec3 &p_point) {
		return p_draft.offset_m + scale * p_point;
	};
	auto scene = std::make_unique<Scene>();
	scene->scene_size_m = StabilityDraft::SCENE_SIZE_M * scale;
	const glm::dmat4 world_from_draft =
			glm::scale(glm::translate(glm::dmat4(1.0), p_draft.offset_m), glm::dvec3(scale));
	for (size_t index = 0; index < p_draft.bodies.size(); ++index) {
		const StabilityBody &body = p_draft.bodies[index];
		auto instance = std::make_unique<MeshInstance3D>();
		instance->name = text(body.name, " ", index);
		instance->surfaces.push_back({ body.mesh, nullptr });
		instance->parent_from_node = world_from_draft * body.world_from_node;
		instance->casts_shadow = body.casts_shadow;
		instance->is_planar_receiver = index == 0;
		scene->root->add_child(std::move(instance));
	}
	auto light = std::make_unique<Light3D>();
	light->name = STABILITY_LIGHT_NAME;
	light->type = p_type;
	light->outer_cone_rad = static_cast<float>(p_draft.cone_rad);
	light->properties = p_draft.properties;
	if (p_type == LightType::DIRECTIONAL) {
		const double tangent = p_draft.light_size_m / p_draft.get_distance_m();
		light->properties["light_angular_distance"] =
				std::min(2.0 * glm::degrees(std::atan(tangent)), MAX_LIGHT_DEGREES);
	} else {
		light->properties["light_size"] = p_draft.light_size_m * scale;
	}
	light->parent_from_node =
			look_at(transform_point(p_draft.light_position), transform_point(p_draft.light_target));
	scene->root->add_child(std::move(light));
	auto camera = std::make_unique<Camera3D>();
	camera->name = "Camera";
	camera->vertical_fov_rad = static_cast<float>(CAMERA_FOV_RAD);
	camera->near_m *= static_cast<float>(scale);
	camera->parent_from_node =
			look_at(transform_point(CAMERA_POSITION), transform_point(p_draft.camera_target));
	scene->root->add_child(std::move(camera));
	return scene;
}

} // namespace

std::unique_ptr<Scene> make_stability_scene(
		const std::string &p_sweep, LightType p_type, double p_value) {
	StabilityDraft draft = make_start();
	if (p_sweep == "guards") {
		change_to_hostile_scene(draft, static_cast<size_t>(p_value));
	} else if (const auto change = get_changes().find(p_sweep); change != get_changes().end()) {
		change->second(draft, p_value);
	}
	return build_scene(draft, p_type);
}

} // namespace gnomon
