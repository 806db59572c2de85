#include "modules/stability_report/stability_draft.h"
#include "modules/stability_report/stability_scenes.h"

#include <functional>

namespace gnomon {

namespace {

/// A scene that once broke a technique, or might: a point of the sweep "guards".
struct HostileScene {
	const char *name;							  // label in reports
	std::function<void(StabilityDraft &)> change; // of the start scene, "as it is"
};

const std::vector<HostileScene> &get_hostile_scenes() {
	// "The light's plane" passes through the light's centre, perpendicular to the direction to its
	// target. A light of another type has the same pose as the spot light.
	static const std::vector<HostileScene> HOSTILE_SCENES = {
		{ "as it is", [](StabilityDraft &) {} }, // the centre of the sweep
		{ "R = 0", [](StabilityDraft &r_draft) { r_draft.light_size_m = 0; } },
		{ "R = 2 S",
				[](StabilityDraft &r_draft) {
					r_draft.light_size_m = 2 * StabilityDraft::SCENE_SIZE_M;
				} },
		{ "light on the receiver's plane",
				[](StabilityDraft &r_draft) {
					r_draft.light_position = { 2.5, 0, 1.7 };
					r_draft.light_target = { 0, 0, 0 };
				} },
		{ "light below everything",
				[](StabilityDraft &r_draft) {
					r_draft.light_position = { 0.3, -5, 0.2 };
					r_draft.light_target = { 0, 0, 0 };
				} },
		{ "light at a caster's corner",
				[](StabilityDraft &r_draft) {
					r_draft.add_box(
							"corner", r_draft.light_position + glm::dvec3(0.3), glm::vec3(0.3f));
				} },
		{ "caster across the light's plane",
				[](StabilityDraft &r_draft) {
					r_draft.add_box("rod", r_draft.light_position + glm::dvec3(-0.35, 0, 0.3),
							{ 0.05f, 1.2f, 0.05f });
				} },
		{ "open mesh across the light's plane",
				[](StabilityDraft &r_draft) {
					r_draft.add_mesh("open mesh", make_open_mesh(),
							r_draft.light_position + glm::dvec3(-0.35, 0, 0.3));
				} },
		{ "zero areas, slivers, duplicates, zero normals",
				[](StabilityDraft &r_draft) {
					r_draft.add_mesh("odd", make_degenerate_mesh(), { 0.2, 1.6, 0.1 });
				} },
		{ "coincident casters",
				[](StabilityDraft &r_draft) {
					// Has the pose and size of "block".
					r_draft.add_box("twin", { 0.2, 0.9, 0.1 }, { 0.35f, 0.25f, 0.35f }, 0.4);
				} },
		{ "caster flush with its receiver",
				[](StabilityDraft &r_draft) {
					r_draft.add_box("flush", { 0.9, 0.2, 0.9 }, { 0.3f, 0.2f, 0.3f }, 0.3);
				} },
		{ "open mesh",
				[](StabilityDraft &r_draft) {
					r_draft.add_mesh("open mesh", make_open_mesh(), { 0.6, 1.5, 0 });
				} },
		{ "box turned inside out",
				[](StabilityDraft &r_draft) {
					r_draft.clear_casters();
					r_draft.add_mesh("inside out", make_inside_out_box(0.4), { 0, 1.0, 0 });
				} },
		{ "no casters",
				[](StabilityDraft &r_draft) {
					r_draft.bodies.resize(1);
					r_draft.bodies[0].casts_shadow = false;
				} },
		{ "no receivers",
				[](StabilityDraft &r_draft) {
					r_draft.camera_target = { -3.2, 40, 4.7 }; // straight above the camera
				} },
		{ "beam from behind the light's plane",
				[](StabilityDraft &r_draft) {
					r_draft.add_box("beam", { 0.3, 0.35, -0.2 }, { 60.0f, 0.3f, 0.5f });
				} },
		{ "ground of 75 S",
				[](StabilityDraft &r_draft) {
					r_draft.add_box("land", { 0, -0.6, 0 }, { 150.0f, 0.1f, 150.0f });
				} },
		{ "caster pressed flat",
				[](StabilityDraft &r_draft) {
					glm::dmat4 &transform = r_draft.bodies[1].world_from_node; // "block"
					transform = glm::scale(transform, glm::dvec3(1, 0, 1));
				} },
		// These change only spot lights.
		{ "cone of 0.001 rad", [](StabilityDraft &r_draft) { r_draft.cone_rad = 1e-3; } },
		{ "cone of a half sphere", [](StabilityDraft &r_draft) { r_draft.cone_rad = 1.5707963; } },
	};
	return HOSTILE_SCENES;
}

} // namespace

std::vector<std::string> list_hostile_scene_names() {
	std::vector<std::string> names;
	for (const HostileScene &scene : get_hostile_scenes()) {
		names.push_back(scene.name);
	}
	return names;
}

void change_to_hostile_scene(StabilityDraft &r_draft, size_t p_index) {
	get_hostile_scenes().at(p_index).change(r_draft);
}

} // namespace gnomon
