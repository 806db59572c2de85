// Tests that valid documents are read into the expected scene.

#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

#include <limits>

using namespace gnomon;

namespace {

const MeshInstance3D &get_instance(const Scene &p_scene) {
	return *p_scene.find_nodes<MeshInstance3D>().at(0);
}

const Mesh &get_mesh(const Scene &p_scene) {
	return *get_instance(p_scene).surfaces.at(0).mesh;
}

} // namespace

TEST_CASE("[GltfReader] interleaved positions and normals are read with their stride") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	GltfTestBuffer buffer;
	const size_t view = buffer.add_view(
			std::vector<float>{ 0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 1 }, 24);
	buffer.add_accessor(view, GLTF_TEST_FLOAT, "VEC3", 3);
	buffer.add_accessor(view, GLTF_TEST_FLOAT, "VEC3", 3, 12);
	buffer.store(json, folder);
	json["meshes"][0]["primitives"][0] = { { "attributes",
			{ { "POSITION", 0 }, { "NORMAL", 1 } } } };
	const auto scene = folder.load(json);
	const Mesh &mesh = get_mesh(*scene);
	CHECK(mesh.positions_node == std::vector<glm::vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 2, 0 } });
	CHECK(mesh.normals_node[2] == glm::vec3(0, 0, 1));
	CHECK(mesh.indices == std::vector<uint32_t>{ 0, 1, 2 });
}

TEST_CASE("[GltfReader] sparse accessors replace elements of a buffer view or of zeros") {
	GltfTestFolder folder;
	for (const bool has_base : { true, false }) {
		CAPTURE(has_base);
		Json json = make_triangle(folder);
		GltfTestBuffer buffer;
		const size_t base = buffer.add_view(std::vector<float>{ 9, 9, 9, 1, 0, 0, 0, 1, 0 });
		const size_t targets = buffer.add_view(std::vector<uint16_t>{ 0, 2 });
		const size_t values = buffer.add_view(std::vector<float>{ 0, 0, 5, 0, 7, 0 });
		buffer.add_accessor(base, GLTF_TEST_FLOAT, "VEC3", 3);
		if (!has_base) {
			buffer.accessors[0].erase("bufferView");
		}
		buffer.accessors[0]["sparse"] = { { "count", 2 },
			{ "indices", { { "bufferView", targets }, { "componentType", GLTF_TEST_USHORT } } },
			{ "values", { { "bufferView", values } } } };
		buffer.store(json, folder);
		json["meshes"][0]["primitives"][0].erase("indices");
		const auto scene = folder.load(json);
		const Mesh &mesh = get_mesh(*scene);
		CHECK(mesh.positions_node[0] == glm::vec3(0, 0, 5));
		CHECK(mesh.positions_node[1] == (has_base ? glm::vec3(1, 0, 0) : glm::vec3(0)));
		CHECK(mesh.positions_node[2] == glm::vec3(0, 7, 0));
	}
}

TEST_CASE("[GltfReader] strips and fans become triangles with their winding; points are skipped") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_triangle(folder);
	GltfTestBuffer buffer;
	const size_t view = buffer.add_view(std::vector<float>{ 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0 });
	buffer.add_accessor(view, GLTF_TEST_FLOAT, "VEC3", 4);
	buffer.store(json, folder);
	Json &primitive = json["meshes"][0]["primitives"][0];
	primitive.erase("indices");
	primitive["mode"] = 5; // TRIANGLE_STRIP
	CHECK(get_mesh(*folder.load(json)).indices == std::vector<uint32_t>{ 0, 1, 2, 1, 3, 2 });
	primitive["mode"] = 6; // TRIANGLE_FAN
	CHECK(get_mesh(*folder.load(json)).indices == std::vector<uint32_t>{ 1, 2, 0, 2, 3, 0 });
	primitive["mode"] = 4; // TRIANGLES: the fourth vertex makes no triangle
	CHECK(get_mesh(*folder.load(json)).positions_node.size() == 3);
	CHECK(log.warnings.empty());
	primitive["mode"] = 0; // POINTS
	json["meshes"][0]["primitives"].push_back(primitive);
	CHECK(get_instance(*folder.load(json)).surfaces.empty());
	CHECK(log.warnings.size() == 1);
}

TEST_CASE("[GltfReader] quantized positions and normals are read, normalized or not") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	json["extensionsRequired"] = { "KHR_mesh_quantization" };
	GltfTestBuffer buffer;
	const size_t positions = buffer.add_view(
			std::vector<int16_t>{ -32768, 0, 0, 0, 32767, 0, 0, 0, 0, 16384, 0, 0 }, 8);
	const size_t normals =
			buffer.add_view(std::vector<int8_t>{ 0, 0, 127, 0, 0, 127, 0, 0, 127, 0, 0, 127 }, 4);
	buffer.add_accessor(positions, GLTF_TEST_SHORT, "VEC3", 3);
	buffer.add_accessor(normals, GLTF_TEST_BYTE, "VEC3", 3);
	buffer.accessors[0]["normalized"] = true;
	buffer.accessors[1]["normalized"] = true;
	buffer.store(json, folder);
	json["meshes"][0]["primitives"][0] = { { "attributes",
			{ { "POSITION", 0 }, { "NORMAL", 1 } } } };
	const auto scene = folder.load(json);
	CHECK(get_mesh(*scene).positions_node[0] == glm::vec3(-1, 0, 0));
	CHECK(get_mesh(*scene).positions_node[1] == glm::vec3(1, 0, 0));
	CHECK(get_mesh(*scene).normals_node[1] == glm::vec3(0, 1, 0));
	json["accessors"][0]["normalized"] = false;
	CHECK(get_mesh(*folder.load(json)).positions_node[0] == glm::vec3(-32768, 0, 0));
}

TEST_CASE("[GltfReader] nodes that share a mesh share its vertices") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	json["nodes"].push_back(json["nodes"][0]);
	json["scenes"][0]["nodes"] = { 0, 1 };
	const auto scene = folder.load(json);
	const auto instances = scene->find_nodes<MeshInstance3D>();
	REQUIRE(instances.size() == 2);
	CHECK(instances[0]->surfaces[0].mesh == instances[1]->surfaces[0].mesh);
	CHECK(instances[0]->name == "Triangle");
	CHECK(instances[1]->name == "Triangle_2");
}

TEST_CASE("[GltfReader] transforms are read in double, as a matrix or as separate properties") {
	GltfTestFolder folder;
	Json json = make_empty_document();
	json["nodes"] = Json::parse(R"([
		{"name": "Parts", "translation": [1000000000.5, 0, 0], "scale": [1, 2, 1],
		 "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "children": [1]},
		{"name": "Matrix", "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0.1,2,3,1]}])");
	const auto scene = folder.load(json); // without scenes: all roots
	const Node3D &parts = *scene->root->children.at(0);
	CHECK(parts.parent_from_node[3].x == 1000000000.5);
	CHECK(glm::length(glm::dvec3(parts.parent_from_node[1]) - glm::dvec3(-2, 0, 0)) < 1e-12);
	REQUIRE(parts.children.size() == 1);
	CHECK(parts.children[0]->parent_from_node[3].x == 0.1);
}

TEST_CASE("[GltfReader] the default scene and its size are read, and names are made unique") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_empty_document();
	json["nodes"] =
			Json::parse(R"([{"name": "A"}, {"name": "A"}, {"name": "A"}, {}, {"name": "A\nB"}])");
	json["scenes"] = Json::parse(
			R"([{"nodes": [0]}, {"nodes": [0, 1, 2, 3, 4], "extras": {"scene_size": 4}}])");
	CHECK(folder.load(json)->root->children.size() == 1); // without "scene": the first scene
	json["scene"] = 1;
	const auto scene = folder.load(json);
	CHECK(scene->scene_size_m == 4);
	std::vector<std::string> names;
	for (const auto &child : scene->root->children) {
		names.push_back(child->name);
	}
	CHECK(names == std::vector<std::string>{ "A", "A_2", "A_3", "Node 3", "A B" });
	json["scenes"][1]["extras"]["scene_size"] = 0;
	CHECK(folder.load(json)->scene_size_m == 0);
	CHECK(GltfTestLog::contains(log.errors, "scenes[1].extras.scene_size is 0"));
}

TEST_CASE("[GltfReader] material values are read from glTF and from extras; invalid ones get "
		  "defaults") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_triangle(folder);
	// Without a material. glTF's default material would have metallic 1.
	CHECK(get_instance(*folder.load(json)).surfaces[0].material->metallic == 0);
	json["meshes"][0]["primitives"][0]["material"] = 0;
	json["materials"] = Json::parse(R"([{"name": "Wax", "doubleSided": true,
		"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1, 1], "roughnessFactor": 0.5,
			"baseColorTexture": {"index": 0}},
		"emissiveFactor": [1, 0, 0.5],
		"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}},
		"extras": {"scatter": 0.75, "scatter_distance": 0.02}}])");
	json["textures"] = Json::parse(R"([{"source": 0}])");
	json["images"] = Json::parse(R"([{"uri": "missing.png"}])");
	const auto scene = folder.load(json);
	const Material wax = *get_instance(*scene).surfaces[0].material;
	CHECK(wax.base_color == glm::vec3(0.5f, 0.25f, 1));
	CHECK(wax.metallic == 1);
	CHECK(wax.roughness == 0.5f);
	CHECK(wax.emissive == glm::vec3(8, 0, 4));
	CHECK(wax.is_double_sided);
	CHECK(wax.scatter == 0.75f);
	CHECK(wax.scatter_distance_m == 0.02f);
	CHECK(log.warnings.empty());
	CHECK(log.errors.size() == 1); // the image
	CHECK(GltfTestLog::contains(log.errors, "images[0].uri cannot be read"));
	json["materials"][0]["extras"] = { { "scatter", 2 }, { "scatter_distance", -1 } };
	CHECK(get_instance(*folder.load(json)).surfaces[0].material->scatter == 0);
	CHECK(GltfTestLog::contains(
			log.errors, "materials[0].extras.scatter is 2, must be 0..1; 0 is used"));
	CHECK(GltfTestLog::contains(log.errors, "materials[0].extras.scatter_distance is -1"));
}

TEST_CASE("[GltfReader] perspective cameras and the shadow flags of meshes are read") {
	GltfTestFolder folder;
	GltfTestLog log;
	Json json = make_triangle(folder);
	json["nodes"][0]["extras"] = { { "shadow_planar_receiver", 1 }, { "casts_shadow", false } };
	json["nodes"].push_back({ { "name", "Eye" }, { "camera", 0 } });
	json["nodes"].push_back({ { "camera", 1 } });
	json["nodes"].push_back({ { "camera", 2 } });
	json["scenes"][0]["nodes"] = { 0, 1, 2, 3 };
	json["cameras"] = Json::parse(R"([
		{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.01}},
		{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}},
		{"type": "perspective", "perspective": {"yfov": 4, "znear": 0}}])");
	const auto scene = folder.load(json);
	CHECK(get_instance(*scene).is_planar_receiver);
	CHECK_FALSE(get_instance(*scene).casts_shadow);
	const auto cameras = scene->find_nodes<Camera3D>();
	REQUIRE(cameras.size() == 2);
	CHECK(cameras[0]->name == "Eye");
	CHECK(cameras[0]->vertical_fov_rad == 0.5f);
	CHECK(cameras[0]->near_m == 0.01f);
	CHECK(cameras[1]->name == "Camera 2");
	CHECK(cameras[1]->near_m == 0.05f); // the default of Camera3D
	CHECK(log.errors.size() == 2);		// yfov and znear of cameras[2]
	CHECK(GltfTestLog::contains(log.warnings, "cameras[1] is not perspective"));
}

TEST_CASE(
		"[GltfReader] the light and the camera of a node with a mesh become children of the mesh") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	json["extensions"] = make_spot_light_document()["extensions"];
	json["nodes"][0]["extensions"] = make_spot_light_document()["nodes"][0]["extensions"];
	json["nodes"][0]["camera"] = 0;
	json["cameras"] = Json::parse(
			R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.01}}])");
	const auto scene = folder.load(json);
	const MeshInstance3D &instance = get_instance(*scene);
	CHECK(instance.name == "Triangle");
	REQUIRE(instance.children.size() == 2);
	CHECK(instance.children[0]->name == "Bulb");
	CHECK(instance.children[1]->name == "Camera 0");
}

TEST_CASE("[GltfReader] buffers come from data URIs, escaped names and the BIN chunk") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	const std::vector<uint8_t> bytes = load_file(folder.path / "data.bin");
	folder.write("a b.bin", bytes);
	json["buffers"][0]["uri"] = "a%20b.bin";
	CHECK(get_mesh(*folder.load(json)).positions_node[1] == glm::vec3(1, 0, 0));
	json["buffers"][0]["uri"] = "data:application/x-anything;base64,"
								"AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIAAAA=";
	CHECK(get_mesh(*folder.load(json)).positions_node[1] == glm::vec3(1, 0, 0));
	json["buffers"][0].erase("uri");
	folder.write("a.glb",
			build_glb({ GltfFormat::BINARY, json.dump(), bytes, /*other_chunks=*/{} },
					{ "a.glb", /*logged=*/{} }));
	CHECK(get_mesh(*load_gltf(folder.path / "a.glb")).positions_node[1] == glm::vec3(1, 0, 0));
}

TEST_CASE("[GltfReader] whole numbers may be written as 3.0, also in lists of indices") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	json["nodes"][0]["children"] = { 1 };
	json["nodes"].push_back({ { "name", "Bone" } });
	json["nodes"][0]["skin"] = 0;
	json["skins"] = Json::parse(R"([{"joints": [1, 0]}])");
	json["nodes"][0]["extras"] = { { "casts_shadow", 0 } };
	const auto scene = folder.load(json);
	const std::string integers = json.dump();
	std::string numbers;
	for (size_t index = 0; index < integers.size(); ++index) {
		const bool ends_number = std::isdigit(uint8_t(integers[index])) &&
				std::strchr(",]}", integers[index + 1]) && integers[index + 1] != '\0';
		numbers += integers[index];
		numbers += ends_number ? ".0" : "";
	}
	const auto same = folder.load(Json::parse(numbers));
	CHECK(numbers.find("\"joints\":[1.0,0.0]") != numbers.npos);
	CHECK(find_difference(*scene, *same) == "");
	REQUIRE(same->find_nodes<MeshInstance3D>().size() == 1);
	CHECK(same->find_nodes<MeshInstance3D>()[0]->skin->joints == std::vector<int>{ 1, 0 });
}
