#include "modules/editor/scene_rays.h"
#include "modules/gltf_scene/tests/animated_test_file.h"
#include "modules/scene/animation.h"
#include "modules/scene/box_mesh.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;

namespace {

/// Makes a square of two by two metres in the plane z = 0, whose right half has alpha 0.
std::unique_ptr<MeshInstance3D> make_half_card(AlphaMode p_mode) {
	const std::vector<glm::vec3> positions = { { -1, -1, 0 }, { 1, -1, 0 }, { 1, 1, 0 },
		{ -1, 1, 0 } };
	MeshAttributes attributes;
	attributes.uvs[0] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
	auto material = std::make_shared<Material>();
	material->alpha_mode = p_mode;
	material->base_color_texture.image =
			make_image("half", { 2, 1 }, { 255, 255, 255, 255, 255, 255, 255, 0 });
	material->base_color_texture.wrap_u = TextureWrap::CLAMP;
	auto card = std::make_unique<MeshInstance3D>();
	card->name = "Card";
	card->surfaces.push_back(
			{ make_mesh("card", positions, {}, { 0, 1, 2, 0, 2, 3 }, attributes), material });
	return card;
}

/// Returns the name of the node that a ray along -Z at X hits first; empty: none.
std::string pick(SceneRays &r_rays, double p_x) {
	const auto hit = r_rays.find_nearest(glm::dvec3(p_x, 0.25, 5), glm::dvec3(0, 0, -1));
	return hit ? hit->instance->node->name : "";
}

} // namespace

TEST_CASE("[SceneRays] a ray through an alpha-tested hole hits the node behind it") {
	for (const AlphaMode mode : { AlphaMode::MASK, AlphaMode::OPAQUE }) {
		Scene scene;
		scene.root->add_child(make_half_card(mode));
		auto wall = std::make_unique<MeshInstance3D>();
		wall->name = "Wall";
		wall->surfaces.push_back(
				{ make_box_mesh("wall", glm::vec3(4, 4, 0.1f)), std::make_shared<Material>() });
		wall->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -2));
		scene.root->add_child(std::move(wall));
		SceneRays rays;
		rays.update_scene(scene);
		CHECK(pick(rays, -0.5) == "Card");
		CHECK(pick(rays, 0.5) == (mode == AlphaMode::MASK ? "Wall" : "Card"));
		CHECK(pick(rays, 2.0) == "Wall");
		CHECK(pick(rays, 9.0) == "");
	}
}

TEST_CASE("[SceneRays] a ray hits animated nodes at their current pose") {
	const GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	const auto animation = find_animation(*scene, "Move");
	SceneRays rays;
	// Skinned moves along X by 5 m/s. Flag is behind it, at x = 0, and its morph weight moves it
	// upwards by 1.5 m/s; at rest the weight is 0.25. See make_animated.
	for (const double time_s : { 0.0, 0.4, 1.0, 2.0 }) {
		CAPTURE(time_s);
		pose_scene(*scene, animation.get(), time_s);
		rays.update_scene(*scene);
		CHECK(pick(rays, 5 * time_s) == "Skinned");
		CHECK(pick(rays, 5 * time_s + 0.4) == "Skinned");
		CHECK(pick(rays, 5 * time_s + 0.6) == "");
		const auto flag =
				rays.find_nearest(glm::dvec3(0.2, 1.5 * time_s + 0.9, -4), glm::dvec3(0, 0, -1));
		REQUIRE(flag);
		CHECK(flag->instance->node->name == "Flag");
		CHECK_FALSE(
				rays.find_nearest(glm::dvec3(0.2, 1.5 * time_s + 1.1, -4), glm::dvec3(0, 0, -1)));
	}
	CHECK(pick(rays, 0) == ""); // both have moved away
	// For the same pose, the mesh and its ray tree are reused; another pose gives another mesh.
	const uint64_t id = rays.get_instances().front().mesh->id;
	rays.update_scene(*scene);
	CHECK(rays.get_instances().front().mesh->id == id);
	CHECK(rays.get_tree_count() == 2);
	pose_scene(*scene, nullptr, 0);
	rays.update_scene(*scene);
	CHECK(rays.get_instances().front().mesh->id != id);
	CHECK(rays.get_tree_count() == 0);
	CHECK(pick(rays, 0) == "Skinned");
}

TEST_CASE("[SceneRays] rays ignore a node with an invalid pose, but no other node") {
	const GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	scene->find_node<MeshInstance3D>("Flag", "mesh").morph_weights[0] = 1e30f;
	SceneRays rays;
	rays.update_scene(*scene);
	CHECK(rays.get_instances().size() == 1);
	CHECK(pick(rays, 0) == "Skinned");
}
