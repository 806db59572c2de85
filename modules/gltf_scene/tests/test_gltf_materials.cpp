// Tests how materials are read from a file, changed and saved.

#include "modules/gltf_scene/gltf_materials.h"
#include "modules/gltf_scene/tests/gltf_test_files.h"
#include "modules/scene/node_properties.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

/// Returns a document of two nodes that share a mesh with a material, which has data unknown to the
/// program. A second material is not used.
Json make_wax_document(const GltfTestFolder &p_folder) {
	Json json = make_triangle(p_folder);
	json["extensionsUsed"] = { "KHR_materials_transmission", "KHR_materials_volume", "X_odd" };
	json["materials"] = Json::parse(R"([{"name": "Wax", "alphaMode": "BLEND",
		"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 0.125], "metallicFactor": 0},
		"extensions": {"X_odd": {"a": [1, 2]},
			"KHR_materials_transmission": {"transmissionFactor": 0.75},
			"KHR_materials_volume": {"thicknessFactor": 0.5, "attenuationDistance": 0.25,
				"attenuationColor": [0.5, 1, 0.25]}},
		"extras": {"scatter": 0.5, "mine": {"preserved": true}}}, {"name": "Unused"}])");
	json["meshes"][0]["primitives"][0]["material"] = 0;
	json["meshes"][0]["extras"] = { { "preserved", 1 } };
	json["nodes"].push_back({ { "mesh", 0 }, { "name", "Second" } });
	json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
	return json;
}

std::vector<MeshInstance3D *> get_instances(const Scene &p_scene) {
	return p_scene.find_nodes<MeshInstance3D>();
}

} // namespace

TEST_CASE("[GltfMaterials] transmission and volume are read and determine the transmittance") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_wax_document(folder);
	const auto scene = folder.load(json);
	const Material wax = *get_instances(*scene)[0]->surfaces[0].material;
	CHECK(wax.transmission == 0.75f);
	CHECK(wax.thickness_m == 0.5f);
	CHECK(wax.attenuation_distance_m == 0.25f);
	CHECK(wax.attenuation_color == glm::vec3(0.5f, 1, 0.25f));
	CHECK(wax.scatter_distance_m == 0.25f); // from the volume, because the extras have none
	// transmission * base colour * attenuation colour^(scale * thickness / attenuation distance);
	// the exponent is 2 at scale 1 and 4 at scale 2.
	const glm::vec3 transmittance = wax.compute_transmittance(1.0f);
	CHECK(transmittance.x == doctest::Approx(0.75 * 0.5 * 0.25));
	CHECK(transmittance.y == doctest::Approx(0.75 * 0.25));
	CHECK(transmittance.z == doctest::Approx(0.75 * 1 * 0.0625));
	CHECK(wax.compute_transmittance(2.0f).x == doctest::Approx(0.75 * 0.5 * 0.0625));
	json["materials"][0]["extras"]["scatter_distance"] = 0.125;
	const auto explicit_distance = folder.load(json);
	CHECK(get_instances(*explicit_distance)[0]->surfaces[0].material->scatter_distance_m == 0.125f);
	json["materials"][0]["extras"]["scatter"] = 0;
	json["materials"][0]["extras"].erase("scatter_distance");
	const auto without_scatter = folder.load(json);
	CHECK(get_instances(*without_scatter)[0]->surfaces[0].material->scatter_distance_m == 0);
	CHECK(log.errors.empty());
	CHECK(Material().compute_transmittance(1.0f) == glm::vec3(0.0f));
}

TEST_CASE("[GltfMaterials] invalid values are reported with their location and range") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_wax_document(folder);
	Json &material = json["materials"][0];
	material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1.5;
	material["extensions"]["KHR_materials_volume"]["thicknessFactor"] = -1;
	material["extras"]["shading_model"] = "toon";
	const auto scene = folder.load(json);
	CHECK(get_instances(*scene)[0]->surfaces[0].material->transmission == 0);
	CHECK(get_instances(*scene)[0]->surfaces[0].material->shading_model ==
			ShadingModel::METALLIC_ROUGHNESS);
	CHECK(log.errors.size() == 3);
	CHECK(GltfTestLog::contains(log.errors, "transmissionFactor is 1.5, must be 0..1"));
	CHECK(GltfTestLog::contains(log.errors, "thicknessFactor is -1"));
	CHECK(GltfTestLog::contains(
			log.errors, "shading_model is \"toon\", must be metallic_roughness or phong"));
}

TEST_CASE("[GltfMaterials] a changed material is replaced in the file and nothing else changes") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json expected = make_wax_document(folder);
	expected["nodes"].erase(1);
	expected["scenes"][0]["nodes"].erase(1);
	const auto scene = folder.load(expected);
	MeshInstance3D &instance = *get_instances(*scene)[0];
	set_node_property(instance, "scatter", 0.25);
	set_node_property(instance, "scatter_distance", 0.0625);
	set_node_property(instance, "shading_model", std::string("phong"));
	set_node_property(instance, "transmission", 0.0);
	set_node_property(instance, "base_color", glm::dvec3(0.25, 0.5, 0.75));
	save_gltf(*scene, folder.path / "again.gltf");
	Json &material = expected["materials"][0];
	material["extras"]["scatter"] = 0.25;
	material["extras"]["scatter_distance"] = 0.0625;
	material["extras"]["shading_model"] = "phong";
	material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.0;
	material["pbrMetallicRoughness"]["baseColorFactor"] = { 0.25, 0.5, 0.75, 0.125 };
	CHECK(folder.read_json("again.gltf") == expected);
	const auto again = load_gltf(folder.path / "again.gltf");
	CHECK(*get_instances(*again)[0]->surfaces[0].material == *instance.surfaces[0].material);
	// Saves again after another change of the same loaded scene.
	set_node_property(instance, "scatter", 0.5);
	save_gltf(*scene, folder.path / "again.gltf");
	material["extras"]["scatter"] = 0.5;
	CHECK(folder.read_json("again.gltf") == expected);
}

TEST_CASE("[GltfMaterials] changing a node's material does not change nodes that shared it") {
	GltfTestFolder folder;
	GltfTestLog log;
	const Json before = make_wax_document(folder);
	const auto scene = folder.load(before);
	set_node_property(*get_instances(*scene)[1], "scatter", 1.0);
	CHECK(get_instances(*scene)[0]->surfaces[0].material->scatter == 0.5f);
	save_gltf(*scene, folder.path / "again.gltf");
	const Json after = folder.read_json("again.gltf");
	REQUIRE(after["materials"].size() == 3);
	CHECK(after["materials"][0] == before["materials"][0]);
	Json expected = before["materials"][0];
	expected["extras"]["scatter"] = 1.0;
	CHECK(sort_keys(after["materials"][2]) == sort_keys(expected)); // with all unknown data
	REQUIRE(after["meshes"].size() == 2);
	CHECK(after["accessors"] == before["accessors"]); // the vertices are shared
	CHECK(after["meshes"][1]["primitives"][0]["material"] == 2);
	CHECK(after["meshes"][1]["extras"] == before["meshes"][0]["extras"]);
	const auto again = load_gltf(folder.path / "again.gltf");
	CHECK(get_instances(*again)[0]->surfaces[0].material->scatter == 0.5f);
	CHECK(get_instances(*again)[1]->surfaces[0].material->scatter == 1.0f);
	// With the same change in both nodes, the old material is replaced.
	set_node_property(*get_instances(*scene)[0], "scatter", 1.0);
	save_gltf(*scene, folder.path / "alike.gltf");
	const Json alike = folder.read_json("alike.gltf");
	CHECK(alike["materials"].size() == 2);
	CHECK(alike["materials"][0] == expected);
	CHECK(alike["meshes"] == before["meshes"]);
}

TEST_CASE("[GltfMaterials] a new scene's materials are written in full") {
	GltfTestFolder folder;
	GltfTestLog log;
	Scene scene;
	auto node = std::make_unique<MeshInstance3D>();
	node->name = "Pane";
	auto glass = std::make_shared<Material>();
	glass->name = "Glass";
	glass->transmission = 0.5f;
	glass->thickness_m = 0.25f;
	glass->attenuation_color = glm::vec3(0.5f, 0.75f, 1);
	glass->attenuation_distance_m = 2;
	glass->shading_model = ShadingModel::PHONG;
	node->surfaces.push_back(
			{ make_mesh("pane", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {}, { 0, 1, 2 }),
					glass });
	scene.root->add_child(std::move(node));
	save_gltf(scene, folder.path / "new.gltf");
	const auto again = load_gltf(folder.path / "new.gltf");
	Material read = *get_instances(*again)[0]->surfaces[0].material;
	CHECK(read.file_index == 0);
	read.file_index = -1;
	CHECK(read == *glass);
	const Json json = folder.read_json("new.gltf");
	CHECK(json["extensionsUsed"] == Json({ "KHR_materials_transmission", "KHR_materials_volume" }));
}

TEST_CASE("[GltfMaterials] the scatter distance is preserved when the attenuation distance from "
		  "which it was derived changes") {
	GltfTestFolder folder;
	GltfTestLog log;
	const Json json = make_wax_document(folder);
	const auto save_and_load = [&](const Scene &p_scene) {
		save_gltf(p_scene, folder.path / "again.gltf");
		const auto again = load_gltf(folder.path / "again.gltf");
		return *get_instances(*again)[0]->surfaces[0].material;
	};
	const auto scene = folder.load(json);
	MeshInstance3D &instance = *get_instances(*scene)[0];
	CHECK(save_and_load(*scene).scatter_distance_m == 0.25f);
	CHECK_FALSE(
			folder.read_json("again.gltf")["materials"][0]["extras"].contains("scatter_distance"));
	set_node_property(instance, "attenuation_distance", 0.5);
	CHECK(save_and_load(*scene).scatter_distance_m == 0.25f);
	set_node_property(instance, "scatter_distance", 0.0);
	CHECK(save_and_load(*scene).scatter_distance_m == 0.0f);
	CHECK(save_and_load(*scene).attenuation_distance_m == 0.5f);
	Json without_scatter = json;
	without_scatter["materials"][0].erase("extras");
	const auto other = folder.load(without_scatter); // its scatter distance is 0
	set_node_property(*get_instances(*other)[0], "scatter", 0.5);
	CHECK(save_and_load(*other).scatter_distance_m == 0.0f);
	CHECK(save_and_load(*other).scatter == 0.5f);
}

TEST_CASE("[GltfMaterials] lines and unknown data of a mesh are preserved when a copied node's "
		  "material changes") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_wax_document(folder);
	Json &primitives = json["meshes"][0]["primitives"];
	Json lines = primitives[0];
	lines["mode"] = 1; // LINES
	lines["extras"] = { { "drawn", "by hand" } };
	primitives.insert(primitives.begin(), lines);
	const auto scene = folder.load(json);
	// Copies the second node, and gives the copy and the second node different materials.
	auto copy = get_instances(*scene)[1]->copy();
	copy->name = "Copy";
	copy->file_index = -1;
	Node3D *added = scene->root->add_child(std::move(copy));
	set_node_property(*added, "roughness", 0.25);
	set_node_property(*get_instances(*scene)[1], "roughness", 0.5);
	save_gltf(*scene, folder.path / "again.gltf");
	const Json after = folder.read_json("again.gltf");
	CHECK(after["accessors"] == json["accessors"]);
	REQUIRE(after["meshes"].size() == 3);
	for (const Json &mesh : after["meshes"]) {
		REQUIRE(mesh["primitives"].size() == 2);
		CHECK(sort_keys(mesh["primitives"][0]) == sort_keys(lines));
		CHECK(mesh["extras"] == json["meshes"][0]["extras"]);
	}
	const auto again = load_gltf(folder.path / "again.gltf");
	REQUIRE(get_instances(*again).size() == 3);
	CHECK(get_instances(*again)[0]->surfaces[0].material->roughness == 1.0f);
	CHECK(get_instances(*again)[1]->surfaces[0].material->roughness == 0.5f);
	CHECK(get_instances(*again)[2]->surfaces[0].material->roughness == 0.25f);
}

TEST_CASE("[GltfMaterials] changing a material does not change other scenes of the file") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_wax_document(folder);
	json["scenes"][0]["nodes"].erase(1);
	json["scenes"].push_back({ { "nodes", { json["nodes"].size() - 1 } } });
	json["scene"] = 0;
	const auto scene = folder.load(json);
	REQUIRE(get_instances(*scene).size() == 1);
	set_node_property(*get_instances(*scene)[0], "scatter", 1.0);
	save_gltf(*scene, folder.path / "again.gltf");
	Json after = folder.read_json("again.gltf");
	CHECK(after["materials"][0] == json["materials"][0]);
	CHECK(after["materials"].size() == 3);
	after["scene"] = 1;
	CHECK(get_instances(*folder.load(after))[0]->surfaces[0].material->scatter == 0.5f);
}
