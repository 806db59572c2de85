// Tests the reading of skins, morph targets and animations from valid and invalid files.

#include "modules/gltf_scene/tests/gltf_test_files.h"
#include "modules/scene/animation.h"
#include "modules/scene/mesh_rig.h"
#include "modules/scene/scene_snapshot.h"

#include <doctest/doctest.h>

#include <limits>

using namespace gnomon;

namespace {

const float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
const std::vector<float> IDENTITY = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };

/// The data of a document with a skinned and morphed triangle and its animation. Tests modify it
/// before make.
struct MotionDocument {
	std::vector<float> weights = { 1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 0, 1, 0, 0 };
	std::vector<uint8_t> joints = { 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0 };
	std::vector<float> inverse_bind_matrices = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, //
		1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1 };
	std::vector<float> deltas = { 0, 0, 1, 0, 0, 1, 0, 0, 1 };
	std::vector<float> times = { 0, 1, 3 };
	std::vector<float> translations = { 0, 0, 0, 2, 0, 0, 2, 4, 0 };
	std::vector<float> animated_weights = { 0, 1, 0.5f };

	/// Returns the document. Node 0 has the mesh, node 1 is the skin's frame, 2 and 3 are joints.
	Json make(const GltfTestFolder &p_folder) const {
		GltfTestBuffer buffer;
		const auto add = [&](const auto &p_values, int p_type, const char *p_shape,
								 size_t p_count) {
			return buffer.add_accessor(buffer.add_view(p_values), p_type, p_shape, p_count);
		};
		add(std::vector<float>{ 0, 0, 0, 1, 0, 0, 0, 1, 0 }, GLTF_TEST_FLOAT, "VEC3", 3);		// 0
		add(std::vector<uint16_t>{ 0, 1, 2 }, GLTF_TEST_USHORT, "SCALAR", 3);					// 1
		add(joints, GLTF_TEST_UBYTE, "VEC4", joints.size() / 4);								// 2
		add(weights, GLTF_TEST_FLOAT, "VEC4", weights.size() / 4);								// 3
		add(inverse_bind_matrices, GLTF_TEST_FLOAT, "MAT4", inverse_bind_matrices.size() / 16); // 4
		add(deltas, GLTF_TEST_FLOAT, "VEC3", deltas.size() / 3);								// 5
		add(times, GLTF_TEST_FLOAT, "SCALAR", times.size());									// 6
		add(translations, GLTF_TEST_FLOAT, "VEC3", translations.size() / 3);					// 7
		add(animated_weights, GLTF_TEST_FLOAT, "SCALAR", animated_weights.size());				// 8
		Json json = Json::parse(R"({
			"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
			"nodes": [{"name": "Body", "mesh": 0, "skin": 0, "scale": [7, 7, 7]},
				{"name": "Frame", "children": [2], "translation": [0, 5, 0]},
				{"name": "Hip", "children": [3]},
				{"name": "Knee", "translation": [1, 0, 0]}],
			"meshes": [{"name": "body", "weights": [0.25], "primitives": [{"attributes":
				{"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1,
				"targets": [{"POSITION": 5}]}]}],
			"skins": [{"joints": [2, 3], "inverseBindMatrices": 4}],
			"animations": [{"name": "Walk",
				"samplers": [{"input": 6, "output": 7}, {"input": 6, "output": 8, "interpolation": "STEP"}],
				"channels": [{"sampler": 0, "target": {"node": 3, "path": "translation"}},
					{"sampler": 1, "target": {"node": 0, "path": "weights"}}]}]
		})");
		buffer.store(json, p_folder);
		return json;
	}
};

std::unique_ptr<Scene> load_with_log(
		const GltfTestFolder &p_folder, const Json &p_json, std::vector<std::string> &r_errors) {
	GltfTestLog log;
	auto scene = p_folder.load(p_json);
	r_errors = log.errors;
	r_errors.insert(r_errors.end(), log.warnings.begin(), log.warnings.end());
	return scene;
}

} // namespace

TEST_CASE("gltf motion: a skin, a morph target and an animation are read") {
	const GltfTestFolder folder;
	std::vector<std::string> messages;
	const auto scene = load_with_log(folder, MotionDocument().make(folder), messages);
	CHECK(messages.empty());
	MeshInstance3D &body = scene->find_node<MeshInstance3D>("Body", "Mesh");
	REQUIRE(body.skin);
	CHECK(body.skin->joints == std::vector<int>{ 2, 3 });
	CHECK(body.skin->frame == 1);
	CHECK(body.skin->joint_from_mesh[1][3].x == -1);
	CHECK(body.morph_weights == std::vector<float>{ 0.25f });
	const MeshRig &rig = *body.surfaces[0].mesh->attributes.rig;
	CHECK(rig.influence_count == 4);
	CHECK(rig.joint_count == 2);
	CHECK(rig.targets.size() == 1);
	REQUIRE(scene->animations.size() == 1);
	CHECK(scene->animations[0]->name == "Walk");
	CHECK(scene->animations[0]->duration_s == 3);
	Camera3D camera;
	// The node's own scale has no effect; the target lifts z by its weight.
	auto snapshot = build_snapshot(*scene, camera);
	CHECK(snapshot->instances[0].world_from_node[3].y == 5);
	auto mesh = snapshot->instances[0].get_posed_mesh();
	CHECK(mesh->positions_node[1] == glm::vec3(1, 0, 0.25f));
	pose_scene(*scene, scene->animations[0].get(), 0.5);
	snapshot = build_snapshot(*scene, camera);
	mesh = snapshot->instances[0].get_posed_mesh();
	// The knee is at x = 1, as at rest; the weight is 0 until 1 s.
	CHECK(mesh->positions_node[1] == glm::vec3(1, 0, 0));
	pose_scene(*scene, scene->animations[0].get(), 3);
	snapshot = build_snapshot(*scene, camera);
	mesh = snapshot->instances[0].get_posed_mesh();
	// The knee is at (2, 4), a translation of (1, 4) from its bind pose. Vertex 1 moves by half of
	// that, vertex 2 by all of it.
	CHECK(mesh->positions_node[1] == glm::vec3(1.5f, 2, 0.5f));
	CHECK(mesh->positions_node[2] == glm::vec3(1, 5, 0.5f));
}

TEST_CASE("gltf motion: a second set of joints with normalized byte weights is read") {
	const GltfTestFolder folder;
	const MotionDocument motion;
	Json json = motion.make(folder);
	GltfTestBuffer buffer;
	buffer.bytes = load_file(folder.path / "data.bin");
	buffer.views = json["bufferViews"];
	buffer.accessors = json["accessors"];
	const std::vector<uint16_t> joints = { 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0 };
	const std::vector<uint8_t> weights = { 255, 0, 0, 0, 0, 0, 0, 0, 255, 0, 0, 0 };
	const size_t first = buffer.add_accessor(buffer.add_view(joints), GLTF_TEST_USHORT, "VEC4", 3);
	const size_t second = buffer.add_accessor(buffer.add_view(weights), GLTF_TEST_UBYTE, "VEC4", 3);
	buffer.accessors[second]["normalized"] = true;
	buffer.store(json, folder);
	Json &attributes = json["meshes"][0]["primitives"][0]["attributes"];
	attributes["JOINTS_1"] = first;
	attributes["WEIGHTS_1"] = second;
	const auto scene = folder.load(json);
	const MeshRig &rig = *scene->find_nodes<MeshInstance3D>()[0]->surfaces[0].mesh->attributes.rig;
	CHECK(rig.influence_count == 8);
	CHECK(rig.weights[0] == 0.5f); // 1 of the first set and 1 of the second
	CHECK(rig.weights[4] == 0.5f);
	CHECK(rig.joints[4] == 1);
}

TEST_CASE("gltf motion: invalid skins and morph targets are rejected with their location") {
	const GltfTestFolder folder;
	const auto check_error = [&](const Json &p_json, const std::string &p_text_part) {
		const std::string message = get_load_error(folder, p_json);
		CAPTURE(message);
		CHECK(message.find(p_text_part) != std::string::npos);
		CHECK(message.find('\n') == std::string::npos);
	};
	MotionDocument motion;
	motion.weights[5] = NOT_A_NUMBER;
	check_error(motion.make(folder), "weight 1 of vertex 1 is nan, must be 0..1");
	motion = {};
	motion.joints[4] = 9;
	motion.weights[4] = 1;
	check_error(motion.make(folder), "which has 2 joints, but the mesh uses joint 9");
	motion = {};
	motion.weights.resize(8);
	check_error(motion.make(folder), "WEIGHTS_0 has 2 elements, must be 3, one per POSITION");
	motion = {};
	motion.inverse_bind_matrices = IDENTITY;
	check_error(motion.make(folder), "inverseBindMatrices has 1 elements, must be at least 2");
	motion = {};
	motion.inverse_bind_matrices[20] = NOT_A_NUMBER;
	check_error(motion.make(folder), "skins[0].inverseBindMatrices[1] is not finite");
	motion = {};
	motion.deltas[4] = NOT_A_NUMBER;
	check_error(motion.make(folder), "morph target 0, vertex 1 is not finite");
	motion = {};
	motion.deltas.resize(6);
	check_error(motion.make(folder), "targets[0].POSITION has 2 elements, must be 3");
	motion = {};
	Json json = motion.make(folder);
	json["skins"][0]["joints"] = Json::array();
	check_error(json, "skins[0].joints has 0 elements, must be 1..65536");
	json["skins"][0]["joints"] = std::vector<int>(1000000, 2);
	check_error(json, "skins[0].joints has 1000000 elements, must be 1..65536");
	json["skins"][0]["joints"] = { 2, 17 };
	check_error(json, "skins[0].joints[1] is 17, must be 0..3");
	json = motion.make(folder);
	json["nodes"][0]["skin"] = 4;
	check_error(json, "nodes[0].skin is 4, must be 0");
	json = motion.make(folder);
	json["nodes"][3]["children"] = { 1 }; // the frame is a child of the knee
	check_error(json, "is its own ancestor");
	json = motion.make(folder);
	json["accessors"][2]["componentType"] = GLTF_TEST_FLOAT;
	json["accessors"][2]["bufferView"] = 3;
	json["accessors"][2]["count"] = 3;
	check_error(json, "must be whole numbers in 0..65535");
	json = motion.make(folder);
	json["accessors"][4]["type"] = "VEC4";
	check_error(json, "accessors[4].type is \"VEC4\", must be \"MAT4\"");
}

TEST_CASE("gltf motion: a channel that cannot be played is skipped and the rest is loaded") {
	const GltfTestFolder folder;
	const auto check = [&](const Json &p_json, const std::string &p_text_part,
							   size_t p_channel_count) {
		std::vector<std::string> messages;
		const auto scene = load_with_log(folder, p_json, messages);
		CAPTURE(p_text_part);
		CAPTURE((messages.empty() ? "" : messages[0]));
		CHECK(GltfTestLog::contains(messages, p_text_part));
		REQUIRE(scene->animations.size() == 1);
		CHECK(scene->animations[0]->channels.size() == p_channel_count);
		pose_scene(*scene, scene->animations[0].get(), 1);
		Camera3D camera;
		CHECK(build_snapshot(*scene, camera)->instances.size() == 1);
	};
	MotionDocument motion;
	motion.times = { 0, NOT_A_NUMBER, 3 };
	check(motion.make(folder),
			"samplers[0].input has nan at 1, must be finite times in s that ascend", 0);
	motion = {};
	motion.times = { 0, 2, 2 };
	check(motion.make(folder), "samplers[1].input has 2 at 2", 0);
	motion = {};
	motion.translations[4] = NOT_A_NUMBER;
	check(motion.make(folder), "samplers[0].output has a number that is not finite at 4", 1);
	motion = {};
	motion.animated_weights.push_back(1);
	check(motion.make(folder), "samplers[1].output has 4 numbers, must be 3, for 3 times", 1);
	motion = {};
	Json json = motion.make(folder);
	json["animations"][0]["channels"][0]["target"]["node"] = 9;
	check(json, "channels[0].target.node is 9, must be 0..3; no motion is used", 1);
	json = motion.make(folder);
	json["animations"][0]["channels"][0]["sampler"] = 2;
	check(json, "channels[0].sampler is 2, must be 0..1", 1);
	json = motion.make(folder);
	json["animations"][0]["channels"][0]["target"]["path"] = "colour";
	check(json, "target.path is \"colour\", must be \"translation\"", 1);
	json = motion.make(folder);
	json["animations"][0]["channels"][1]["target"]["node"] = 2;
	check(json, "nodes[2] has no mesh with morph targets", 1);
	json = motion.make(folder);
	// An unknown interpolation is replaced by LINEAR, so that both channels remain.
	json["animations"][0]["samplers"][0]["interpolation"] = "BOUNCE";
	check(json, "interpolation is \"BOUNCE\", must be \"LINEAR\", \"STEP\" or \"CUBICSPLINE\"", 2);
	json = motion.make(folder);
	json["animations"][0]["channels"][0]["target"] = { { "path", "pointer" },
		{ "extensions", { { "KHR_animation_pointer", { { "pointer", "/nodes/0/scale" } } } } } };
	check(json, "KHR_animation_pointer is not read", 1);
	json = motion.make(folder);
	// A target without node is valid, because an extension may define it: no message.
	json["animations"][0]["channels"][0]["target"].erase("node");
	std::vector<std::string> messages;
	CHECK(load_with_log(folder, json, messages)->animations[0]->channels.size() == 1);
	CHECK(messages.empty());
	json = motion.make(folder);
	// Bad weights of a node are replaced by the default, so that both channels remain.
	json["nodes"][0]["weights"] = { "much" };
	check(json, "nodes[0].weights is an array of 1, must be a list of finite numbers", 2);
}

TEST_CASE("gltf motion: animations with zero scale are played") {
	const GltfTestFolder folder;
	MotionDocument motion;
	motion.translations.assign(9, 0.0f);
	Json json = motion.make(folder);
	json["animations"][0]["channels"][0]["target"]["path"] = "scale";
	json["nodes"][1]["scale"] = { 0, 0, 0 };
	const auto scene = folder.load(json);
	Camera3D camera;
	for (const double time_s : { 0.0, 1.5, 3.0 }) {
		pose_scene(*scene, scene->animations[0].get(), time_s);
		const auto snapshot = build_snapshot(*scene, camera);
		CHECK(snapshot->instances.size() == 1);
		for (const glm::vec3 &normal : snapshot->instances[0].get_posed_mesh()->normals_node) {
			CHECK(glm::length(normal) == doctest::Approx(1));
		}
	}
}

TEST_CASE("gltf motion: saving preserves skins and animations and does not write the pose") {
	const GltfTestFolder folder;
	const auto scene = folder.load(MotionDocument().make(folder));
	pose_scene(*scene, scene->animations[0].get(), 2);
	save_gltf(*scene, folder.path / "saved.gltf");
	const Json before = folder.read_json("scene.gltf");
	const Json after = folder.read_json("saved.gltf");
	CHECK(sort_keys(before["nodes"]) == sort_keys(after["nodes"]));
	CHECK(sort_keys(before["skins"]) == sort_keys(after["skins"]));
	CHECK(sort_keys(before["animations"]) == sort_keys(after["animations"]));
	CHECK(sort_keys(before["meshes"]) == sort_keys(after["meshes"]));
}
