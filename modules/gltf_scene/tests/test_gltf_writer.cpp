// Tests what saving preserves, changes and rejects, for loaded and for generated scenes.

#ifndef _WIN32
#include "modules/core/tests/killed_process.h"
#endif
#include "modules/gltf_scene/tests/gltf_test_files.h"
#include "modules/scene/tests/test_trees.h"

#include <doctest/doctest.h>
#include <glm/gtc/matrix_transform.hpp>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

/// Returns a document of a light above a triangle, with data unknown to the program.
Json make_desk(const GltfTestFolder &p_folder) {
	Json json = make_triangle(p_folder);
	const Json lamp = make_spot_light_document();
	json["asset"]["copyright"] = "somebody";
	json["extensions"] = lamp["extensions"];
	json["extensionsUsed"] = { "KHR_lights_punctual", "ACME_dust" };
	json["extensions"]["ACME_dust"] = { { "density", 0.125 } };
	Json &light = json["extensions"]["KHR_lights_punctual"]["lights"][0];
	light["extras"] = Json::parse(
			R"({"light_size": 0.2, "shadow_soft_size": 0.2, "note": "preserved", "list": [1, [2]]})");
	light["extensions"] = { { "ACME_filter", { { "gel", 201 } } } };
	json["nodes"].push_back(lamp["nodes"][0]);
	json["nodes"][1]["translation"] = { 0, 3, 0 };
	json["nodes"][1]["extras"] = { { "owner", "lighting" } };
	json["nodes"][0]["extras"] = "a plain text";
	json["scenes"][0]["nodes"] = { 0, 1 };
	json["scenes"][0]["extras"] = { { "weather", "dry" } };
	json["images"] = Json::parse(R"([{"uri": "wood.png"}])");
	json["animations"] = Json::array();
	json["animations"].push_back({ { "channels", Json::array() }, { "samplers", Json::array() } });
	p_folder.write("wood.png", std::string("not really an image"));
	return json;
}

Light3D &get_light(Scene &p_scene) {
	return *p_scene.find_nodes<Light3D>().at(0);
}

std::unique_ptr<Scene> make_generated_scene() {
	auto scene = std::make_unique<Scene>();
	scene->scene_size_m = 4;
	auto *box = add_child<MeshInstance3D>(*scene->root, "Box");
	box->parent_from_node = glm::rotate(glm::dmat4(1.0), 0.4, glm::dvec3(0, 1, 0));
	box->is_planar_receiver = true;
	auto wax = std::make_shared<Material>();
	wax->name = "Wax";
	wax->base_color = glm::vec3(0.1f, 0.2f, 0.3f);
	wax->metallic = 0.25f;
	wax->roughness = 0.7f;
	wax->scatter = 0.6f;
	wax->scatter_distance_m = 0.03f;
	wax->emissive = glm::vec3(4, 2, 1);
	wax->is_double_sided = true;
	box->surfaces.push_back(
			{ make_mesh("box", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {}, { 0, 1, 2 }), wax });
	auto *copy = add_child<MeshInstance3D>(*box, "Copy");
	copy->surfaces = box->surfaces;
	copy->casts_shadow = false;
	copy->parent_from_node = glm::translate(glm::dmat4(1.0), glm::dvec3(0.1, 1e9 + 0.1, 0));
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		auto *light = add_child<Light3D>(*scene->root, "Light " + std::to_string(int(type)));
		light->type = type;
		light->intensity = 12.3f;
		light->color = glm::vec3(0.1f, 0.7f, 1);
		light->range_m = type == LightType::OMNI ? 9.9f : 0.0f;
		light->inner_cone_rad = type == LightType::SPOT ? 0.1f : 0.0f;
		light->outer_cone_rad = type == LightType::SPOT ? 0.76f : 0.785398163f; // default: pi / 4
		light->properties = { { "light_size", 0.4 }, { "shadow_enabled", false },
			{ "shadow_technique", std::string("later") }, { "later_taps", int64_t(32) } };
		light->parent_from_node = glm::inverse(
				glm::lookAt(glm::dvec3(1.8, 6, 1.2), glm::dvec3(0, 0.4, 0), glm::dvec3(0, 1, 0)));
	}
	auto *camera = add_child<Camera3D>(*scene->root, "Camera");
	camera->vertical_fov_rad = 0.6435f;
	camera->near_m = 0.02f;
	return scene;
}

/// Loads a file in which one node has a mesh and a light.
std::unique_ptr<Scene> load_mesh_with_light(const GltfTestFolder &p_folder) {
	Json json = make_triangle(p_folder);
	json["extensions"] = make_spot_light_document()["extensions"];
	json["nodes"][0]["extensions"] = make_spot_light_document()["nodes"][0]["extensions"];
	return p_folder.load(json);
}

} // namespace

TEST_CASE("[GltfWriter] saving an unchanged scene preserves every value of the file") {
	GltfTestFolder folder;
	GltfTestLog log;
	const Json json = make_desk(folder);
	const auto scene = folder.load(json);
	save_gltf(*scene, folder.path / "again.gltf");
	CHECK(folder.read_json("again.gltf") == json);
	CHECK(find_difference(*scene, *load_gltf(folder.path / "again.gltf")) == "");
}

TEST_CASE("[GltfWriter] data that tinygltf does not store is preserved, in its order") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_desk(folder);
	json["later"] = Json::parse(R"([1, null, {"z": [], "a": {}}])");
	json["nodes"][1]["later"] = true;
	json["nodes"][1]["skin"] = 0;
	json["nodes"][1]["extras"] = Json::parse(
			R"({"owner": "lighting", "none": null, "list": [], "seed": 9007199254740993, "mixed": [null, 1]})");
	json["skins"] = Json::parse(R"([{"joints": [1]}])");
	json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] =
			Json::parse(R"({"bufferView": 0, "attributes": {"POSITION": 0}})");
	json["images"].push_back(Json::parse(R"({"bufferView": 0, "mimeType": "image/png"})"));
	json["images"].push_back(Json::parse(R"({"uri": "data:image/png;base64,AAAA"})"));
	json["cameras"] = Json::parse(
			R"([{"type": "perspective", "perspective": {"yfov": 9, "znear": 1, "later": 2}},
		{"type": "later"}])");
	json["materials"] = Json::parse(
			R"([{"pbrMetallicRoughness": {"roughnessFactor": 7, "metallicFactor": "x"}}])");
	json["meshes"][0]["primitives"][0]["material"] = 0;
	const auto scene = folder.load(json);
	get_light(*scene).parent_from_node[3] = glm::dvec4(0, 5, 0, 1);
	get_light(*scene).properties["light_size"] = 0.5;
	save_gltf(*scene, folder.path / "again.gltf");
	json["nodes"][1]["translation"] = { 0, 5, 0 };
	Json &extras = json["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"];
	extras["light_size"] = extras["shadow_soft_size"] = 0.5;
	CHECK(folder.read_json("again.gltf") == json);
}

TEST_CASE("[GltfWriter] changes of a light and the scene size change nothing else in the file") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json expected = make_desk(folder);
	const auto scene = folder.load(expected);
	Light3D &light = get_light(*scene);
	light.parent_from_node[3] = glm::dvec4(0.1, 4, -2, 1);
	light.properties["light_size"] = 0.5;
	light.properties["penumbra_outer_width"] = -1.0;
	light.intensity = 0.3f;
	scene->scene_size_m = 4;
	save_gltf(*scene, folder.path / "scene.gltf");
	expected["nodes"][1]["translation"] = { 0.1, 4, -2 };
	Json &definition = expected["extensions"]["KHR_lights_punctual"]["lights"][0];
	definition["extras"]["light_size"] = 0.5;
	definition["extras"]["shadow_soft_size"] = 0.5; // an alias of light_size
	definition["extras"]["penumbra_outer_width"] = -1.0;
	definition["intensity"] = 0.3;
	expected["scenes"][0]["extras"]["scene_size"] = 4.0;
	CHECK(folder.read_json("scene.gltf") == expected);
	CHECK(find_difference(*scene, *load_gltf(folder.path / "scene.gltf")) == "");
}

TEST_CASE("[GltfWriter] an unset property stays unset, even if several objects had it") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_desk(folder);
	json["nodes"][1]["extras"]["light_size"] = 0.9;
	const auto scene = folder.load(json);
	get_light(*scene).properties.erase("light_size");
	save_gltf(*scene, folder.path / "again.gltf");
	const auto again = load_gltf(folder.path / "again.gltf");
	CHECK_FALSE(get_light(*again).properties.contains("light_size"));
	CHECK(folder.read_json("again.gltf")["nodes"][1]["extras"]["owner"] == "lighting");
}

TEST_CASE("[GltfWriter] a light size from an area light is written to the area light") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	json["extensions"]["EXT_lights_area"]["lights"] = Json::array();
	json["extensions"]["EXT_lights_area"]["lights"].push_back(
			{ { "type", "disk" }, { "size", 0.6 } });
	json["nodes"][0]["extensions"]["EXT_lights_area"] = { { "light", 0 } };
	const auto scene = folder.load(json);
	get_light(*scene).properties["light_size"] = 0.7;
	save_gltf(*scene, folder.path / "again.gltf");
	CHECK(get_light(*load_gltf(folder.path / "again.gltf")).properties ==
			PropertyValues{ { "light_size", 0.7 } });
}

TEST_CASE("[GltfWriter] changing one of two nodes that share a light does not change the other") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	json["nodes"].push_back(json["nodes"][0]);
	json["scenes"][0]["nodes"] = { 0, 1 };
	const auto scene = folder.load(json);
	get_light(*scene).properties["light_size"] = 0.7;
	save_gltf(*scene, folder.path / "again.gltf");
	CHECK(find_difference(*scene, *load_gltf(folder.path / "again.gltf")) == "");
}

TEST_CASE("[GltfWriter] rotated, sheared and scaled nodes are saved and loaded unchanged") {
	GltfTestFolder folder;
	GltfTestLog log;
	const auto scene = folder.load(make_desk(folder));
	Light3D &light = get_light(*scene);
	light.parent_from_node =
			glm::rotate(glm::dmat4(1.0), 2.9, glm::normalize(glm::dvec3(3, -1, 2))) *
			glm::scale(glm::dmat4(1.0), glm::dvec3(-1, 2, 1e-3));
	save_gltf(*scene, folder.path / "a.gltf");
	CHECK(folder.read_json("a.gltf")["nodes"][1].contains("rotation"));
	CHECK(find_difference(*scene, *load_gltf(folder.path / "a.gltf")) == "");
	light.parent_from_node[0] += light.parent_from_node[1] * 0.3;
	save_gltf(*scene, folder.path / "a.gltf");
	CHECK(folder.read_json("a.gltf")["nodes"][1].contains("matrix"));
	CHECK(find_difference(*scene, *load_gltf(folder.path / "a.gltf")) == "");
}

TEST_CASE("[GltfWriter] saving in another folder copies buffers and images and overwrites none") {
	GltfTestFolder folder;
	GltfTestFolder other;
	GltfTestLog log;
	const auto scene = folder.load(make_desk(folder));
	other.write("data.bin", std::string("somebody else's"));
	save_gltf(*scene, other.path / "copy.gltf");
	CHECK(load_text_file(other.path / "data.bin") == "somebody else's");
	CHECK(other.read_json("copy.gltf")["buffers"][0]["uri"] == "data_2.bin");
	CHECK(load_text_file(other.path / "wood.png") == "not really an image");
	save_gltf(*scene, other.path / "copy.gltf"); // reuses the file with the same content
	CHECK(other.read_json("copy.gltf")["buffers"][0]["uri"] == "data_2.bin");
	CHECK(find_difference(*scene, *load_gltf(other.path / "copy.gltf")) == "");
}

TEST_CASE("[GltfWriter] binary and text form can be converted; unknown chunks are preserved") {
	GltfTestFolder folder;
	GltfTestLog log;
	const auto scene = folder.load(make_desk(folder));
	save_gltf(*scene, folder.path / "desk.glb");
	fs::remove(folder.path / "data.bin");
	auto binary = load_gltf(folder.path / "desk.glb");
	CHECK(find_difference(*scene, *binary) == "");
	get_light(*binary).properties["light_size"] = 0.6;
	save_gltf(*binary, folder.path / "desk.glb");
	CHECK(find_difference(*binary, *load_gltf(folder.path / "desk.glb")) == "");
	save_gltf(*binary, folder.path / "desk.gltf");
	CHECK(find_difference(*binary, *load_gltf(folder.path / "desk.gltf")) == "");
	CHECK(fs::exists(folder.path / "desk.bin"));

	std::vector<uint8_t> bytes = load_file(folder.path / "desk.glb");
	const std::vector<uint8_t> chunk = { 4, 0, 0, 0, 'N', 'O', 'T', 'E', 1, 2, 3, 4 };
	bytes.insert(bytes.end(), chunk.begin(), chunk.end());
	const uint32_t length = static_cast<uint32_t>(bytes.size());
	std::memcpy(bytes.data() + 8, &length, sizeof(length)); // the header's file length
	folder.write("note.glb", bytes);
	save_gltf(*load_gltf(folder.path / "note.glb"), folder.path / "note2.glb");
	CHECK(load_file(folder.path / "note2.glb") == bytes);
}

TEST_CASE("[GltfWriter] a generated scene is saved in full, in both forms") {
	GltfTestFolder folder;
	const auto scene = make_generated_scene();
	for (const char *name : { "made.gltf", "made.glb", "made.gltf" }) {
		CAPTURE(name);
		save_gltf(*scene, folder.path / name);
		CHECK(find_difference(*scene, *load_gltf(folder.path / name)) == "");
	}
	const Json json = folder.read_json("made.gltf");
	CHECK(json["meshes"].size() == 1); // shared by two nodes
	CHECK(json["accessors"][0].contains("min"));
	CHECK(json["extensionsUsed"].size() == 2); // lights and emissive strength
	CHECK(json["buffers"][0]["uri"] == "made.bin");
	CHECK(json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"].dump() == "12.3");
}

TEST_CASE("[GltfWriter] a staged node is not saved, unless one of its descendants is saved") {
	GltfTestFolder folder;
	GltfTestLog log;
	const Json json = make_desk(folder);
	const auto scene = folder.load(json);
	auto *stage = add_child<Node3D>(*scene->root, "Stage");
	stage->is_staged = true;
	auto *light = add_child<Light3D>(*stage, "Added");
	light->is_staged = true;
	save_gltf(*scene, folder.path / "again.gltf");
	CHECK(folder.read_json("again.gltf") == json);
	light->is_staged = false;
	save_gltf(*scene, folder.path / "again.gltf");
	const auto again = load_gltf(folder.path / "again.gltf");
	REQUIRE(again->find_nodes<Light3D>().size() == 2);
	CHECK(again->find_node<Light3D>("Added", "Light").parent->name == "Stage");
}

#ifndef _WIN32 // which has no fork; tests/platforms/test_saves.py kills programs there
namespace {

size_t count_files(const fs::path &p_folder) {
	return size_t(std::distance(fs::directory_iterator(p_folder), {}));
}

} // namespace

TEST_CASE("[GltfWriter] a process killed while saving leaves the old or the new scene complete") {
	GltfTestFolder folder;
	GltfTestLog log;
	for (const char *name : { "made.gltf", "made.glb" }) {
		CAPTURE(name);
		const fs::path path = folder.path / name;
		const auto before = make_generated_scene();
		const auto after = make_generated_scene();
		add_child<MeshInstance3D>(*after->root, "More")
				->surfaces.push_back({ make_mesh("more", { { 0, 0, 0 }, { 3, 0, 0 }, { 0, 3, 0 } },
											   {}, { 0, 1, 2 }),
						std::make_shared<Material>() });
		save_gltf(*before, path);
		const size_t file_count = count_files(folder.path);
		size_t new_count = 0;
		const size_t kill_count = kill_at_each_save_step([&] { save_gltf(*after, path); },
				[&] {
					const auto found = load_gltf(path);
					const bool is_new = find_difference(*after, *found).empty();
					CHECK((is_new || find_difference(*before, *found).empty()));
					new_count += is_new;
				});
		CHECK(kill_count >= 4); // a file is created, written, synced and renamed
		CHECK(new_count >= 1);
		// Files do not accumulate. One buffer may remain from a kill before the old one was
		// removed.
		remove_left_over_files(folder.path);
		for (int repeat = 0; repeat < 3; ++repeat) {
			save_gltf(*before, path);
			save_gltf(*after, path);
		}
		CHECK(count_files(folder.path) <= file_count + 1);
		CHECK(find_difference(*after, *load_gltf(path)) == "");
	}
}
#endif

TEST_CASE("[GltfWriter] nodes can be added, removed and given another parent") {
	GltfTestFolder folder;
	GltfTestLog log;
	for (const char *name : { "again.gltf", "again.glb" }) {
		CAPTURE(name);
		const auto scene = folder.load(make_desk(folder));
		// The light becomes a child of a new mesh, and the triangle is removed.
		auto light = std::move(scene->root->children[1]);
		light->parent = nullptr;
		scene->root->children.clear();
		auto *box = add_child<MeshInstance3D>(*scene->root, "Box");
		box->surfaces.push_back(
				{ make_mesh("box", { { 0, 0, 0 }, { 2, 0, 0 }, { 0, 2, 0 } }, {}, { 0, 1, 2 }),
						std::make_shared<Material>() });
		box->add_child(std::move(light));
		add_child<Camera3D>(*scene->root, "Camera");
		save_gltf(*scene, folder.path / name);
		const auto again = load_gltf(folder.path / name);
		CHECK(find_difference(*scene, *again) == "");
		again->root->children.clear();
		save_gltf(*again, folder.path / name);
		CHECK(load_gltf(folder.path / name)->root->children.empty());
	}
}

TEST_CASE("[GltfWriter] a light in the node of a mesh can be changed, moved and removed") {
	GltfTestFolder folder;
	const auto scene = load_mesh_with_light(folder);
	Light3D &light = get_light(*scene);
	light.properties["light_size"] = 0.3;
	save_gltf(*scene, folder.path / "a.gltf");
	CHECK(folder.read_json("a.gltf")["nodes"].size() == 1);
	CHECK(find_difference(*scene, *load_gltf(folder.path / "a.gltf")) == "");
	light.parent_from_node[3].y = 2;
	save_gltf(*scene, folder.path / "a.gltf");
	CHECK(folder.read_json("a.gltf")["nodes"].size() == 2);
	CHECK(find_difference(*scene, *load_gltf(folder.path / "a.gltf")) == "");
	light.parent->children.clear();
	save_gltf(*scene, folder.path / "a.gltf");
	CHECK(find_difference(*scene, *load_gltf(folder.path / "a.gltf")) == "");
}

TEST_CASE("[GltfWriter] a light in the node of a mesh can be renamed") {
	GltfTestFolder folder;
	const auto scene = load_mesh_with_light(folder);
	Light3D &light = get_light(*scene);
	light.name = "Key light";
	light.properties["light_size"] = 0.3;
	save_gltf(*scene, folder.path / "a.gltf");
	const auto again = load_gltf(folder.path / "a.gltf");
	CHECK(get_light(*again).name == "Key light");
	CHECK(find_difference(*scene, *again) == "");
}

TEST_CASE("[GltfWriter] a Blender light in a child node keeps its size when it or its parent is "
		  "renamed") {
	GltfTestFolder folder;
	Json json = make_spot_light_document();
	json["nodes"] = Json::parse(R"([
		{"name": "Lamp", "children": [1], "extras": {"light_size": 0.35}},
		{"name": "Lamp_Orientation", "extensions": {"KHR_lights_punctual": {"light": 0}}}])");
	json["scenes"][0]["nodes"] = { 0 };
	const auto scene = folder.load(json);
	Light3D &light = get_light(*scene);
	light.name = "Other";
	save_gltf(*scene, folder.path / "a.gltf");
	CHECK(std::get<double>(
				  get_light(*load_gltf(folder.path / "a.gltf")).properties.at("light_size")) ==
			0.35);
	light.parent->name = "Key";
	save_gltf(*scene, folder.path / "a.gltf");
	const auto again = load_gltf(folder.path / "a.gltf");
	CHECK(get_light(*again).parent->name == "Key");
	CHECK(std::get<double>(get_light(*again).properties.at("light_size")) == 0.35);
}

TEST_CASE("[GltfWriter] invalid paths and values that are not finite are rejected") {
	GltfTestFolder folder;
	GltfTestLog log;
	const auto scene = folder.load(make_desk(folder));
	const std::string before = load_text_file(folder.path / "scene.gltf");
	CHECK_THROWS_WITH_AS(
			save_gltf(*scene, folder.path / "a.obj"), doctest::Contains(".gltf or .glb"), Error);
	CHECK_THROWS_AS(save_gltf(*scene, folder.path / "missing" / "a.gltf"), Error);
	get_light(*scene).intensity = NAN;
	CHECK_THROWS_WITH_AS(save_gltf(*scene, folder.path / "scene.gltf"),
			doctest::Contains("Light \"Lamp\": intensity is not finite"), Error);
	get_light(*scene).intensity = 1;
	get_light(*scene).parent_from_node[1].y = INFINITY;
	CHECK_THROWS_WITH_AS(save_gltf(*scene, folder.path / "scene.gltf"),
			doctest::Contains("Node \"Lamp\""), Error);
	CHECK(load_text_file(folder.path / "scene.gltf") == before);
}
