#include "modules/gltf_scene/tests/animated_test_file.h"
#include "modules/scene/animation.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

MeshInstance3D &find(const Scene &p_scene, const char *p_name) {
	return p_scene.find_node<MeshInstance3D>(p_name, "mesh");
}

/// Adds a copy of the node to the scene. Like any new node it has file_index -1.
MeshInstance3D &copy(Scene &r_scene, const char *p_name) {
	std::unique_ptr<Node3D> made = find(r_scene, p_name).copy();
	made->name += " 2";
	made->file_index = -1;
	return static_cast<MeshInstance3D &>(*r_scene.root->add_child(std::move(made)));
}

} // namespace

TEST_CASE("[GltfWriter] the pose of an animation is not saved") {
	GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	save_gltf(*scene, folder.path / "rest.gltf");
	pose_scene(*scene, find_animation(*scene, "Move").get(), 1.5);
	REQUIRE(find(*scene, "Flag").posed_morph_weights);
	save_gltf(*scene, folder.path / "posed.gltf");
	CHECK(load_text_file(folder.path / "posed.gltf") == load_text_file(folder.path / "rest.gltf"));
}

TEST_CASE("[GltfWriter] a copied node has the skin and morph weights of its original") {
	GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	copy(*scene, "Skinned");
	copy(*scene, "Flag");
	save_gltf(*scene, folder.path / "again.gltf");
	const Json json = folder.read_json("again.gltf");
	REQUIRE(json["nodes"].size() == 6);
	CHECK(json["nodes"][4] == Json::parse(R"({"name": "Skinned 2", "mesh": 0, "skin": 0})"));
	CHECK(json["nodes"][5]["weights"] == Json::parse("[0.25]"));
	CHECK(json["nodes"][5]["mesh"] == 1);
	CHECK(json["skins"].size() == 1);
	CHECK(json["meshes"].size() == 2);
	const auto again = load_gltf(folder.path / "again.gltf");
	CHECK(find(*again, "Skinned 2").skin == find(*again, "Skinned").skin);
	CHECK(find(*again, "Flag 2").get_morph_weights() == std::vector<float>{ 0.25f });
}

TEST_CASE("[GltfWriter] a copied node with another material also has the skin and morph weights") {
	GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	auto red = std::make_shared<Material>();
	red->base_color = glm::vec3(1, 0, 0);
	for (const char *name : { "Skinned", "Flag" }) {
		copy(*scene, name).surfaces[0].material = red;
	}
	save_gltf(*scene, folder.path / "again.gltf");
	const auto again = load_gltf(folder.path / "again.gltf");
	for (const char *name : { "Skinned 2", "Flag 2" }) {
		const MeshInstance3D &node = find(*again, name);
		CHECK(node.surfaces[0].mesh->attributes.rig);
		CHECK(node.surfaces[0].material->base_color == red->base_color);
	}
	CHECK(find(*again, "Skinned 2").skin);
	CHECK(find(*again, "Flag 2").get_morph_weights() == std::vector<float>{ 0.25f });
}

TEST_CASE("[GltfWriter] a copied node does not repeat the default morph weights of its mesh") {
	GltfTestFolder folder;
	Json json = make_animated(folder);
	json["meshes"][1]["weights"] = { 0.25 };
	json["nodes"][3].erase("weights");
	const auto scene = folder.load(json);
	copy(*scene, "Flag");
	save_gltf(*scene, folder.path / "again.gltf");
	CHECK_FALSE(folder.read_json("again.gltf")["nodes"][4].contains("weights"));
	CHECK(find(*load_gltf(folder.path / "again.gltf"), "Flag 2").get_morph_weights() ==
			std::vector<float>{ 0.25f });
}

TEST_CASE("[GltfWriter] a skinned mesh is saved without its skin in another scene's file") {
	GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	Scene other;
	auto node = find(*scene, "Skinned").copy();
	node->file_index = -1;
	other.root->add_child(std::move(node));
	save_gltf(other, folder.path / "other.gltf");
	CHECK_FALSE(folder.read_json("other.gltf")["nodes"][0].contains("skin"));
	CHECK_FALSE(find(*load_gltf(folder.path / "other.gltf"), "Skinned").skin);
}

TEST_CASE("[GltfWriter] a mesh keeps its vertex attributes and alpha test in another scene's file; "
		  "lost textures are logged") {
	GltfTestFolder folder;
	GltfTestLog log;
	auto leaf = std::make_shared<Material>();
	leaf->name = "Leaf";
	leaf->alpha = 0.75f;
	leaf->alpha_mode = AlphaMode::MASK;
	leaf->alpha_cutoff = 0.25f;
	leaf->base_color_texture.image = std::make_shared<Image>();
	MeshAttributes attributes;
	attributes.uvs[0] = { { 0, 0 }, { 1, 0 }, { 0, 1 } };
	attributes.uvs[1] = { { 0, 0 }, { 0.5, 0 }, { 0, 0.5 } };
	attributes.tangents.assign(3, { 1, 0, 0, -1 });
	attributes.colors = { { 1, 0, 0, 1 }, { 0, 1, 0, 0.5 }, { 0, 0, 1, 1 } };
	auto card = std::make_unique<MeshInstance3D>();
	card->name = "Card";
	card->surfaces.push_back({ make_mesh("card", { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }, {},
									   { 0, 1, 2 }, attributes),
			leaf });
	Scene scene;
	scene.root->add_child(std::move(card));
	save_gltf(scene, folder.path / "card.gltf");
	CHECK(log.contains(log.warnings, "\"Leaf\" is saved without its textures"));
	const Json primitive = folder.read_json("card.gltf")["meshes"][0]["primitives"][0];
	for (const char *name :
			{ "POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0" }) {
		CAPTURE(name);
		CHECK(primitive["attributes"].contains(name));
	}
	const auto loaded = load_gltf(folder.path / "card.gltf");
	const MeshInstance3D::Surface &surface = find(*loaded, "Card").surfaces.at(0);
	CHECK(surface.mesh->attributes.colors == attributes.colors);
	CHECK(surface.material->alpha == 0.75f);
	CHECK(surface.material->alpha_mode == AlphaMode::MASK);
	CHECK(surface.material->alpha_cutoff == 0.25f);
}

TEST_CASE("[GltfWriter] a node whose mesh is removed also loses its skin and morph weights") {
	GltfTestFolder folder;
	const auto scene = folder.load(make_animated(folder));
	for (const char *name : { "Skinned", "Flag" }) {
		const MeshInstance3D &mesh = find(*scene, name);
		auto plain = std::make_unique<Node3D>();
		plain->name = mesh.name;
		plain->file_index = mesh.file_index;
		plain->parent_from_node = mesh.parent_from_node;
		scene->root->remove_child(mesh);
		scene->root->add_child(std::move(plain));
	}
	save_gltf(*scene, folder.path / "again.gltf");
	const Json nodes = folder.read_json("again.gltf")["nodes"];
	REQUIRE(nodes.size() == 4);
	for (const char *member : { "mesh", "skin", "weights" }) {
		CHECK_FALSE(nodes[2].contains(member));
		CHECK_FALSE(nodes[3].contains(member));
	}
	CHECK(load_gltf(folder.path / "again.gltf")->find_nodes<MeshInstance3D>().empty());
}
