#include "modules/core/error.h"
#include "modules/scene/animation_playback.h"
#include "modules/scene/box_mesh.h"
#include "modules/scene/frame_snapshots.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

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
	const auto first = snapshots.build(scene, camera, SceneChange::NONE);
	REQUIRE(first->instances.size() == 1);
	CHECK(snapshots.build(scene, camera, SceneChange::NONE) == first);

	camera.parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 2, 5));
	const auto second = snapshots.build(scene, camera, SceneChange::NONE);
	CHECK(second != first);
	CHECK(second->camera.position_world == glm::dvec3(0, 2, 5));
	CHECK(first->camera.position_world == glm::dvec3(0, 0, 0));
	CHECK(second->instances.shares_items_with(first->instances));
	CHECK(second->lights.shares_items_with(first->lights));

	added->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, 3));
	const auto third = snapshots.build(scene, camera, SceneChange::ANY);
	CHECK(glm::dvec3(third->instances[0].world_from_node[3]) == glm::dvec3(0, 0, 3));
	CHECK(glm::dvec3(second->instances[0].world_from_node[3]) == glm::dvec3(0, 0, 0));
	camera.name = "Other";
	CHECK(snapshots.build(scene, camera, SceneChange::NONE)->camera.name == "Other");
}

namespace {

glm::dmat4 at(double p_x, double p_y, double p_z) {
	return glm::translate(glm::dmat4(1.0), glm::dvec3(p_x, p_y, p_z));
}

MeshInstance3D *add_box(Node3D &r_parent, const std::string &p_name) {
	auto box = std::make_unique<MeshInstance3D>();
	box->name = p_name;
	box->surfaces.push_back(
			{ make_box_mesh(p_name, glm::vec3(1.0f)), std::make_shared<const Material>() });
	return static_cast<MeshInstance3D *>(r_parent.add_child(std::move(box)));
}

void check_equal(const SceneSnapshot &p_scene, const SceneSnapshot &p_expected) {
	REQUIRE(p_scene.instances.size() == p_expected.instances.size());
	for (size_t index = 0; index < p_scene.instances.size(); ++index) {
		const InstanceSnapshot &instance = p_scene.instances[index];
		const InstanceSnapshot &expected = p_expected.instances[index];
		CHECK(instance.compute_hash(0) == expected.compute_hash(0));
		CHECK(instance.bounds_world.minimum == expected.bounds_world.minimum);
		CHECK(instance.bounds_world.maximum == expected.bounds_world.maximum);
	}
	REQUIRE(p_scene.lights.size() == p_expected.lights.size());
	for (size_t index = 0; index < p_scene.lights.size(); ++index) {
		const LightSnapshot &light = p_scene.lights[index];
		CHECK(light.compute_hash(0) == p_expected.lights[index].compute_hash(0));
		CHECK(light.name == p_expected.lights[index].name);
		CHECK(light.technique_id == p_expected.lights[index].technique_id);
	}
	CHECK(p_scene.scene_size_m == p_expected.scene_size_m);
}

} // namespace

TEST_CASE("[FrameSnapshots] a pose moves what is below posed nodes, and shares the rest") {
	Scene scene;
	for (int index = 0; index < 40; ++index) {
		add_box(*scene.root, "Box")->parent_from_node = at(index, 0, 0);
	}
	Node3D *arm = scene.root->children[20].get();
	arm->posed_parent_from_node = at(20, 1, 0);
	MeshInstance3D *hand = add_box(*arm, "Hand");
	hand->parent_from_node = at(0.1, 0.2, 0.3);
	auto *lamp = static_cast<Light3D *>(hand->add_child(std::make_unique<Light3D>()));
	lamp->name = "Lamp";
	lamp->properties["light_size"] = 0.3;
	scene.root->add_child(std::make_unique<Light3D>())->name = "Sun";
	Camera3D camera;
	camera.name = "Camera";
	FrameSnapshots snapshots;
	const auto first = snapshots.build(scene, camera, SceneChange::ANY);
	CHECK(snapshots.build(scene, camera, SceneChange::POSE)
					->instances.shares_items_with(first->instances));

	arm->posed_parent_from_node = glm::rotate(at(20, 3, 0), 0.7, glm::dvec3(1, 2, 3));
	const auto second = snapshots.build(scene, camera, SceneChange::POSE);
	check_equal(*second, *build_snapshot(scene, camera));
	CHECK(second->instances[20].compute_hash(0) != first->instances[20].compute_hash(0));
	CHECK(second->lights[0].compute_hash(0) != first->lights[0].compute_hash(0));
	CHECK(second->lights[0].light_size_m == 0.3f);
	CHECK(second->instances.find_changed_pages(first->instances).size() == 1);
	// Equal to the first snapshot at rest, where nothing was posed, too.
	arm->posed_parent_from_node = at(20, 1, 0);
	check_equal(*snapshots.build(scene, camera, SceneChange::POSE), *first);

	arm->posed_parent_from_node = at(INFINITY, 0, 0);
	CHECK_THROWS_WITH_AS(snapshots.build(scene, camera, SceneChange::POSE),
			doctest::Contains("its transform to the world is not finite"), Error);
	arm->posed_parent_from_node = at(20, 3, 0);
	check_equal(*snapshots.build(scene, camera, SceneChange::POSE), *build_snapshot(scene, camera));
}

TEST_CASE("[FrameSnapshots] a playback says what may have changed") {
	Scene scene;
	MeshInstance3D *box = add_box(*scene.root, "Box");
	box->file_index = 0;
	const auto make = [](double p_x) {
		auto animation = std::make_shared<Animation>();
		AnimationChannel channel;
		channel.node = 0;
		channel.sampler = { Interpolation::LINEAR, { 0.0f, 1.0f }, 3,
			{ 0.0f, 0.0f, 0.0f, float(p_x), 0.0f, 0.0f } };
		animation->channels.push_back(std::move(channel));
		animation->nodes.push_back({ 0, {} });
		animation->duration_s = 1;
		return animation;
	};
	AnimationPlayback playback;
	playback.animation = make(2.0);
	CHECK(playback.advance(scene, 0.0) == SceneChange::ANY);
	CHECK(playback.advance(scene, 0.0) == SceneChange::NONE);
	CHECK(playback.advance(scene, 0.25) == SceneChange::POSE);
	CHECK(box->get_parent_from_node()[3].x == 0.5);
	playback.animation = make(4.0);
	CHECK(playback.advance(scene, 0.25) == SceneChange::ANY);
	CHECK(box->get_parent_from_node()[3].x == 2.0);
	SUBCASE("a changed tree") {
		scene.root->add_child(std::make_unique<Node3D>());
		CHECK(playback.advance(scene, 0.25) == SceneChange::ANY);
		CHECK(playback.advance(scene, 0.1) == SceneChange::POSE);
		scene.root->remove_child(*box);
		CHECK(playback.advance(scene, 0.1) == SceneChange::ANY);
		CHECK(playback.advance(scene, 0.1) == SceneChange::NONE); // it poses no node
	}
	SUBCASE("another scene") {
		Scene other;
		add_box(*other.root, "Box")->file_index = 0;
		CHECK(playback.advance(other, 0.25) == SceneChange::ANY);
		CHECK(other.root->children[0]->get_parent_from_node()[3].x == 3.0);
	}
	SUBCASE("no animation") {
		playback.animation = nullptr;
		CHECK(playback.advance(scene, 0.25) == SceneChange::ANY);
		CHECK(box->get_parent_from_node() == glm::dmat4(1.0));
		CHECK(playback.advance(scene, 0.25) == SceneChange::NONE);
	}
}
