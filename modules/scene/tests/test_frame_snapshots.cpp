#include "modules/scene/box_mesh.h"
#include "modules/scene/frame_snapshots.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;

TEST_CASE("[FrameSnapshots] frames share instances and lights if only the camera moves") {
	Scene scene;
	auto box = std::make_unique<MeshInstance3D>();
	box->name = "Box";
	box->surfaces.push_back(
			{ make_box_mesh("box", glm::vec3(1.0f)), std::make_shared<const Material>() });
	auto *added = static_cast<MeshInstance3D *>(scene.root->add_child(std::move(box)));
	scene.root->add_child(std::make_unique<Light3D>())->name = "Light";
	Camera3D camera;
	camera.name = "Camera";
	FrameSnapshots snapshots;
	const auto first = snapshots.build(scene, camera, /*p_has_changed=*/false);
	REQUIRE(first->instances.size() == 1);
	CHECK(snapshots.build(scene, camera, /*p_has_changed=*/false) == first);

	camera.parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 2, 5));
	const auto second = snapshots.build(scene, camera, /*p_has_changed=*/false);
	CHECK(second != first);
	CHECK(second->camera.position_world == glm::dvec3(0, 2, 5));
	CHECK(first->camera.position_world == glm::dvec3(0, 0, 0));
	CHECK(second->instances.shares_items_with(first->instances));
	CHECK(second->lights.shares_items_with(first->lights));

	added->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 3));
	const auto third = snapshots.build(scene, camera, /*p_has_changed=*/true);
	CHECK(glm::dvec3(third->instances[0].world_from_node[3]) == glm::dvec3(0, 0, 3));
	CHECK(glm::dvec3(second->instances[0].world_from_node[3]) == glm::dvec3(0, 0, 0));
	camera.name = "Other";
	CHECK(snapshots.build(scene, camera, /*p_has_changed=*/false)->camera.name == "Other");
}
