#pragma once

#include "modules/shadows/tests/mask_fixture.h"

namespace gnomon {

/// Makes the scene a world of 2 km and replaces its box by a plate of 4 cm on the ground, before
/// the camera. The plate is lower than MAX_RECEIVER_OFFSET of this world.
inline void make_wide_world(SmallScene &r_scene) {
	r_scene.scene.scene_size_m = 2000.0;
	r_scene.box->surfaces[0].mesh = make_box_mesh("plate", { 0.5f, 0.02f, 0.4f });
	r_scene.box->parent_from_node = glm::translate(glm::dmat4(1.0), { 0.0, 0.02, 0.0 });
	const auto tower = make_box_mesh("tower", { 5.0f, 30.0f, 5.0f });
	add_mesh(r_scene.scene, "West tower", tower, { -700, 10, 650 });
	add_mesh(r_scene.scene, "East tower", tower, { 700, -20, -700 });
	r_scene.light->parent_from_node = look_at({ 3.0, 1.4, 0.6 }, { 0.0, 0.0, 0.0 });
	r_scene.light->properties["light_size"] = 0.02;
	r_scene.light->properties["light_angular_distance"] = 0.53;
	r_scene.camera->parent_from_node = look_at({ -1.2, 0.9, 1.0 }, { -0.4, 0.0, 0.0 });
}

} // namespace gnomon
