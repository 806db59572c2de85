#include "modules/core/error.h"
#include "modules/scene/nodes.h"
#include "modules/scene/tests/test_trees.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;

TEST_CASE("[Node3D] the world transform is the product of the parents' and the node's own") {
	Scene scene;
	Node3D *arm = add_child<Node3D>(*scene.root, "Arm");
	Light3D *lamp = add_child<Light3D>(*arm, "Lamp");
	arm->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(1e9, 0, 0));
	lamp->parent_from_node = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0));
	const glm::dvec4 point = lamp->compute_world_from_node() * glm::dvec4(0.25, 0, 0, 1);
	CHECK(point.x == 1e9 + 0.5); // a float would lose the half
	CHECK(lamp->parent == arm);
}

TEST_CASE("[Scene] nodes are found by class in tree order, and by name") {
	Scene scene;
	Light3D *first = add_child<Light3D>(*scene.root, "A");
	add_child<Camera3D>(*first, "Camera");
	Light3D *second = add_child<Light3D>(*scene.root, "B");
	CHECK(scene.find_nodes<Light3D>() == std::vector<Light3D *>{ first, second });
	CHECK(&scene.find_node<Light3D>("B", "light") == second);
}

TEST_CASE("[Scene] an unknown name is an error that lists the existing ones") {
	Scene scene;
	scene.path = "desk.gltf";
	CHECK_THROWS_WITH_AS(scene.find_node<Light3D>("Lamp", "light"),
			"Scene \"desk.gltf\" has no light \"Lamp\", and no other light. Add one to the scene.",
			Error);
	add_child<Light3D>(*scene.root, "A");
	add_child<Light3D>(*scene.root, "B");
	CHECK_THROWS_WITH_AS(scene.find_node<Light3D>("Lamp", "light"),
			"Scene \"desk.gltf\" has no light \"Lamp\". Name one of these: \"A\", \"B\".", Error);
}

TEST_CASE("[Light3D] every property has a tooltip, and only penumbra widths may be -1") {
	const PropertyList &list = Light3D::get_property_list();
	for (const char *name : { "light_size", "light_angular_distance", "shadow_enabled",
				 "shadow_technique", "penumbra_outer_width", "penumbra_inner_width" }) {
		REQUIRE(list.find(name));
		CHECK(list.find(name)->tooltip.size() > 40);
	}
	CHECK(list.get_properties().size() == 6);
	CHECK(check_property(*list.find("penumbra_outer_width"), -1.0).empty());
	CHECK_FALSE(check_property(*list.find("penumbra_outer_width"), -0.5).empty());
	CHECK_FALSE(check_property(*list.find("light_size"), -1.0).empty());
	CHECK_FALSE(check_property(*list.find("light_size"), 1e4 + 1).empty());
	CHECK_FALSE(check_property(*list.find("light_angular_distance"), 91.0).empty());
}
