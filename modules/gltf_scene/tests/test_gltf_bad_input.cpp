#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

#include <random>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

/// Returns a small file with a mesh, sparse positions, a camera, a material, and a light with a
/// property that this build does not know.
GltfContainer make_rich_container() {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	const Json lamp = make_spot_light_document();
	json["extensions"] = lamp["extensions"];
	json["extensions"]["KHR_lights_punctual"]["lights"][0]["extras"] = { { "light_size", 0.2 },
		{ "later_taps", 16 } };
	json["nodes"].push_back(lamp["nodes"][0]);
	json["nodes"].push_back({ { "camera", 0 }, { "translation", { 1, 2, 3 } } });
	json["nodes"][0]["children"] = { 1, 2 };
	json["cameras"] = Json::parse(
			R"([{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.01}}])");
	json["materials"] =
			Json::parse(R"([{"pbrMetallicRoughness": {"baseColorFactor": [1,1,1,1]}}])");
	json["meshes"][0]["primitives"][0]["material"] = 0;
	json["accessors"][0]["sparse"] = { { "count", 1 },
		{ "indices", { { "bufferView", 1 }, { "componentType", GLTF_TEST_USHORT } } },
		{ "values", { { "bufferView", 0 } } } };
	json["buffers"][0].erase("uri");
	return { GltfFormat::BINARY, json.dump(), load_file(folder.path / "data.bin"), {} };
}

/// Loads a file. Returns true if it is a scene, or false if it is rejected with an Error in the
/// right form.
bool is_loaded(const fs::path &p_path) {
	try {
		load_gltf(p_path);
		return true;
	} catch (const Error &error) {
		const std::string message = error.what();
		CHECK(message.find('\n') == std::string::npos);
		CHECK(message.find(p_path.filename().string()) != std::string::npos);
		return false;
	}
}

/// Sets one value, by JSON pointer, and checks that loading fails with an error that contains
/// p_expected.
void check_rejected(const GltfTestFolder &p_folder, Json p_json, const char *p_pointer,
		const Json &p_value, const std::string &p_expected) {
	p_json[Json::json_pointer(p_pointer)] = p_value;
	const std::string error = get_load_error(p_folder, p_json);
	CAPTURE(p_pointer);
	CAPTURE(error);
	CHECK(error.find("scene.gltf\": ") != std::string::npos);
	CHECK(error.find(p_expected) != std::string::npos);
	CHECK(error.back() == '.');
}

} // namespace

TEST_CASE("[GltfBadInput] a file that is truncated anywhere is rejected") {
	GltfTestFolder folder;
	GltfTestLog log;
	const GltfContainer container = make_rich_container();
	const std::vector<uint8_t> glb = build_glb(container, GltfMessages());
	folder.write("cut.glb", glb);
	CHECK(is_loaded(folder.path / "cut.glb"));
	const size_t STEP = 7; // bytes; odd, so that lengths of every alignment occur
	for (size_t length = 0; length < glb.size(); length += STEP) {
		CAPTURE(length);
		folder.write("cut.glb", std::span(glb).first(length));
		CHECK_FALSE(is_loaded(folder.path / "cut.glb"));
	}
	const std::string json = make_spot_light_document().dump();
	for (size_t length = 0; length < json.size(); length += STEP) {
		CAPTURE(length);
		folder.write("cut.gltf", std::string_view(json).substr(0, length));
		CHECK_FALSE(is_loaded(folder.path / "cut.gltf"));
	}
	CHECK_THROWS_AS(load_gltf(folder.path / "missing.gltf"), Error);
}

TEST_CASE("[GltfBadInput] invalid numbers are rejected with path, value and range") {
	GltfTestFolder folder;
	const Json json = make_triangle(folder);
	const Json huge = uint64_t(1) << 62;
	CHECK(get_load_error(folder, json) == "");
	// The buffer has 44 bytes: 36 of positions, and 6 of indices, padded to 8.
	check_rejected(folder, json, "/accessors/0/count", 4, "4 elements need 48 bytes");
	check_rejected(folder, json, "/accessors/0/count", 0, "accessors[0].count is 0, must be");
	check_rejected(folder, json, "/accessors/0/count", -1, "accessors[0].count is -1");
	check_rejected(folder, json, "/accessors/0/count", huge, "accessors[0].count is 46116860");
	check_rejected(folder, json, "/accessors/0/byteOffset", huge, "accessors[0].byteOffset");
	check_rejected(folder, json, "/accessors/0/byteOffset", 4, "accessors[0].byteOffset is 4");
	check_rejected(folder, json, "/accessors/0/componentType", 5124, "5120..5123 or 5126");
	check_rejected(folder, json, "/accessors/0/componentType", 5125, "5120..5123 or 5126");
	check_rejected(folder, json, "/accessors/0/type", "VEC4", "accessors[0].type is \"VEC4\"");
	check_rejected(
			folder, json, "/accessors/1/componentType", GLTF_TEST_FLOAT, "5121, 5123 or 5125");
	check_rejected(folder, json, "/accessors/1/type", "VEC3", "must be \"SCALAR\"");
	check_rejected(folder, json, "/accessors/0/bufferView", 2, "bufferView is 2, must be 0..1");
	check_rejected(folder, json, "/bufferViews/0/buffer", 1, "bufferViews[0].buffer is 1");
	check_rejected(folder, json, "/bufferViews/0/byteLength", huge, "bufferViews[0].byteLength");
	check_rejected(folder, json, "/bufferViews/0/byteOffset", huge, "bufferViews[0].byteOffset");
	check_rejected(folder, json, "/bufferViews/0/byteStride", 4, "byteStride is 4, must be");
	check_rejected(folder, json, "/bufferViews/0/byteStride", huge, "byteStride");
	check_rejected(folder, json, "/buffers/0/byteLength", huge, "buffers[0].byteLength");
	check_rejected(folder, json, "/buffers/0/byteLength", 1000, "must be at most 44");
	check_rejected(folder, json, "/meshes/0/primitives/0/mode", 7, "mode is 7, must be");
	check_rejected(folder, json, "/meshes/0/primitives/0/material", 0, "must be absent");
	check_rejected(folder, json, "/meshes/0/primitives/0/attributes/POSITION", 2, "must be 0..1");
	check_rejected(folder, json, "/nodes/0/mesh", 1.5, "nodes[0].mesh is 1.5, must be 0..0");
	check_rejected(folder, json, "/scenes/0/nodes/0", 9, "scenes[0].nodes[0] is 9");
	check_rejected(folder, json, "/scene", 1, "scene is 1, must be 0..0");
	check_rejected(folder, json, "/nodes/0/rotation", { 0, 0, 0, 0 }, "unit quaternion");
	check_rejected(folder, json, "/nodes/0/translation", { 0, "x", 0 }, "3 finite numbers");
	check_rejected(folder, json, "/nodes/0/matrix", { 1, 2 }, "16 finite numbers");
	check_rejected(folder, json, "/nodes/0/matrix", std::vector<int>(16, 1), "last row 0, 0, 0, 1");
	check_rejected(folder, json, "/asset/version", "1.0", "asset.version is \"1.0\"");
}

TEST_CASE("[GltfBadInput] the sparse parts of accessors are checked") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	json["accessors"][0]["sparse"] = { { "count", 1 },
		{ "indices", { { "bufferView", 1 }, { "componentType", GLTF_TEST_USHORT } } },
		{ "values", { { "bufferView", 0 } } } };
	CHECK(get_load_error(folder, json) == "");
	check_rejected(folder, json, "/accessors/0/sparse/count", 4, "sparse.count is 4, must be");
	check_rejected(folder, json, "/accessors/0/sparse/values/byteOffset", 28, "byteOffset is 28");
	check_rejected(folder, json, "/accessors/0/sparse/indices/componentType", 5122, "5121, 5123");
	// 16256 is 0x3f80, the upper half of 1.0f: the indices are read from the positions.
	check_rejected(folder, json, "/accessors/0/sparse/indices",
			{ { "bufferView", 0 }, { "byteOffset", 14 }, { "componentType", GLTF_TEST_USHORT } },
			"accessors[0].sparse.indices[0] is 16256, must be 0..2");
	check_rejected(folder, json, "/accessors/0/sparse/indices/bufferView", 5, "must be 0..1");
}

TEST_CASE("[GltfBadInput] vertices that are not finite and indices out of range are rejected") {
	GltfTestFolder folder;
	const Json json = make_triangle(folder);
	std::vector<uint8_t> bytes = load_file(folder.path / "data.bin");
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const size_t NAN_OFFSET_BYTES = 16; // y of vertex 1
	std::memcpy(bytes.data() + NAN_OFFSET_BYTES, &nan, sizeof(nan));
	folder.write("data.bin", bytes);
	const std::string error = get_load_error(folder, json);
	CHECK(error.find(
				  "meshes[0].primitives[0].attributes.POSITION of mesh \"triangle\": vertex 1") !=
			std::string::npos);
	std::memset(bytes.data() + NAN_OFFSET_BYTES, 0, sizeof(nan));
	bytes[36] = 3; // the first index; there are three vertices
	folder.write("data.bin", bytes);
	CHECK(get_load_error(folder, json).find("accessors[1][0] is 3, must be 0..2") !=
			std::string::npos);
}

TEST_CASE("[GltfBadInput] nodes with cycles, two parents or too many levels are rejected") {
	GltfTestFolder folder;
	Json json = make_empty_document();
	json["nodes"] = Json::parse(R"([{"children": [1]}, {"children": [2]}, {"children": [1]}])");
	CHECK(get_load_error(folder, json).find("nodes[2].children[0] is 1") != std::string::npos);
	json["nodes"] = Json::parse(R"([{}, {"children": [2]}, {"children": [1]}])");
	CHECK(get_load_error(folder, json).find("its own ancestor") != std::string::npos);
	// Node 0 is below the cycle, not on it.
	json["nodes"] = Json::parse(R"([{}, {"children": [0, 2]}, {"children": [1]}])");
	CHECK(get_load_error(folder, json).find("nodes[1] is its own ancestor") != std::string::npos);
	json["nodes"] = Json::parse(R"([{"children": [0]}])");
	CHECK(get_load_error(folder, json).find("its own ancestor") != std::string::npos);
	json["nodes"] = Json::parse(R"([{"children": [1]}, {}])");
	json["scenes"] = Json::parse(R"([{"nodes": [0, 1]}])");
	CHECK(get_load_error(folder, json).find("scenes[0].nodes[1] is 1") != std::string::npos);

	json = make_empty_document(); // a chain of GLTF_MAX_NODE_DEPTH nodes, then of one more
	for (size_t index = 0; index < 1000; ++index) {
		json["nodes"].push_back({ { "children", { index + 1 } } });
	}
	json["nodes"][999].erase("children");
	CHECK(get_load_error(folder, json) == "");
	json["nodes"][999]["children"] = { 1000 };
	json["nodes"].push_back(Json::object());
	CHECK(get_load_error(folder, json).find("must be at most 1000") != std::string::npos);
}

TEST_CASE("[GltfBadInput] JSON that has too many levels or keys, or is not valid, is rejected") {
	GltfTestFolder folder;
	folder.write("scene.gltf", std::string(100000, '['));
	CHECK_THROWS_WITH_AS(
			load_gltf(folder.path / "scene.gltf"), doctest::Contains("nested deeper"), Error);
	// Brackets and commas in the text ]"[, are not counted.
	std::string wide = "{\"a\": \"]\\\"[,\"";
	for (int key = 0; key < 5000; ++key) {
		wide += ",\"" + std::to_string(key) + "\":0";
	}
	folder.write("scene.gltf", wide + "}");
	CHECK_THROWS_WITH_AS(
			load_gltf(folder.path / "scene.gltf"), doctest::Contains("4096 keys"), Error);
	folder.write("scene.gltf", std::string("[1, 2]"));
	CHECK_THROWS_WITH_AS(
			load_gltf(folder.path / "scene.gltf"), doctest::Contains("an array of 2"), Error);
	folder.write("scene.gltf", std::string("{\"asset\": {\"version\": 1e999}}"));
	CHECK_THROWS_WITH_AS(
			load_gltf(folder.path / "scene.gltf"), doctest::Contains("cannot be parsed"), Error);
}

TEST_CASE("[GltfBadInput] a URI that leads out of the project folder or is invalid is rejected") {
	GltfTestFolder outside;
	GltfTestFolder folder;
	const Json json = make_triangle(folder);
	make_triangle(outside);
	const std::string secret = (outside.path / "data.bin").string();
	std::error_code problem;
	fs::create_symlink(secret, folder.path / "link.bin", problem);
	const std::string other = outside.path.filename().string();
	// "C:" at the start of a path is read as the scheme of a URL.
	const bool has_drives = fs::path(secret).has_root_name();
	const std::vector<std::pair<std::string, std::string>> bad = {
		{ secret, has_drives ? "relative path" : "absolute" },
		{ "../" + other + "/data.bin", "leads out" },
		{ "%2e%2e/" + other + "/data.bin", "leads out" }, { "link.bin", "leads out" },
		{ "file://" + secret, "relative path" }, { "http://example.com/a.bin", "relative path" },
		{ "a%00.bin", "% escapes" }, { "a%2", "% escapes" }, { "a%zz.bin", "% escapes" },
		{ "", "% escapes" }, { ".", "cannot be read" }, { "missing.bin", "does not exist" },
		{ "data:application/octet-stream;base64,", "no base64" }, { "data:text,abc", "no base64" },
		{ "data:application/octet-stream;base64,AAAA", "must be at most 3" }
	};
	for (const auto &[uri, expected_text] : bad) {
		CAPTURE(uri);
		if (problem && uri == "link.bin") {
			MESSAGE("symbolic links cannot be made here: ", problem.message());
			continue;
		}
		check_rejected(folder, json, "/buffers/0/uri", uri, expected_text);
	}
	check_rejected(folder, json, "/buffers/0/uri", 3, "buffers[0].uri is 3");
	// If the project folder contains both folders, the file is allowed.
	GltfLoadOptions options;
	options.project_folder = fs::temp_directory_path();
	Json neighbour = json;
	neighbour["buffers"][0]["uri"] = "../" + other + "/data.bin";
	CHECK(get_load_error(folder, neighbour, options) == "");
	options.project_folder = outside.path;
	CHECK(get_load_error(folder, json, options).find("outside of the project") !=
			std::string::npos);
}

TEST_CASE("[GltfBadInput] a file that requires an unsupported extension is rejected") {
	GltfTestFolder folder;
	Json json = make_triangle(folder);
	for (const char *name :
			{ "KHR_draco_mesh_compression", "EXT_meshopt_compression", "ACME_new" }) {
		check_rejected(folder, json, "/extensionsRequired", Json::array({ name }),
				std::string("extensionsRequired[0] is \"") + name + "\"");
	}
	json["extensionsRequired"] = { "KHR_lights_punctual", "KHR_materials_unlit",
		"KHR_texture_transform", "EXT_lights_area", "KHR_mesh_quantization" };
	CHECK(get_load_error(folder, json) == "");
	json["extensionsUsed"] = { "ACME_new" };
	CHECK(get_load_error(folder, json) == "");
}

TEST_CASE("[GltfBadInput] extensions of any JSON type are preserved or rejected") {
	GltfTestFolder folder;
	GltfTestLog log;
	for (const char *pointer : { "/meshes/0/primitives/0/extensions", "/meshes/0/extensions",
				 "/accessors/0/extensions", "/nodes/0/extensions", "/scenes/0/extensions",
				 "/extensions" }) {
		for (const Json &value :
				{ Json(5), Json("x"), Json::array({ 1 }), Json(), Json::object() }) {
			CAPTURE(pointer);
			CAPTURE(value.dump());
			Json json = make_triangle(folder);
			json[Json::json_pointer(pointer)] = value;
			const std::string error = get_load_error(folder, json);
			CHECK((error.empty() || error.find("extensions is ") != std::string::npos));
			if (error.empty()) {
				save_gltf(*load_gltf(folder.path / "scene.gltf"), folder.path / "again.gltf");
				CHECK(folder.read_json("again.gltf") == json);
			}
		}
	}
}

TEST_CASE("[GltfBadInput] many nodes with one name are numbered; a huge accessor is rejected") {
	GltfTestFolder folder;
	Json json = make_empty_document();
	for (int index = 0; index < 20000; ++index) {
		json["nodes"].push_back({ { "name", "A" } });
	}
	// Would take long if each name were searched for from number 2.
	CHECK(folder.load(json)->root->children.back()->name == "A_20000");
	json = make_triangle(folder);
	json["accessors"][0].erase("bufferView");
	check_rejected(folder, json, "/accessors/0/count", 100000000, "without a bufferView");
}

TEST_CASE("[GltfBadInput] files with random damage load or are rejected, without a crash") {
	GltfTestFolder folder;
	GltfTestLog log;
	const GltfContainer container = make_rich_container();
	const std::vector<uint8_t> glb = build_glb(container, GltfMessages());
	folder.write("data.bin", *container.bin_chunk);
	Json json = Json::parse(container.json_text);
	json["buffers"][0]["uri"] = "data.bin";
	const std::string gltf = json.dump();
	const std::vector<uint8_t> text(gltf.begin(), gltf.end());
	std::mt19937 random(20100901); // any fixed seed
	const char JSON_CHARACTERS[] = "0123456789-.eE[]{}\",:";
	unsigned loaded_count = 0;
	for (unsigned round = 0; round < 2000; ++round) {
		CAPTURE(round);
		const bool is_binary = round % 2 == 0;
		std::vector<uint8_t> bytes = is_binary ? glb : text;
		const unsigned change_count = 1 + random() % 3;
		for (unsigned change = 0; change < change_count; ++change) {
			// Half of the changes use characters of numbers and JSON, so that more files still
			// parse.
			uint8_t &byte = bytes[random() % bytes.size()];
			byte = random() % 2 == 0
					? static_cast<uint8_t>(random())
					: static_cast<uint8_t>(
							  JSON_CHARACTERS[random() % (sizeof(JSON_CHARACTERS) - 1)]);
		}
		const char *name = is_binary ? "damaged.glb" : "damaged.gltf";
		folder.write(name, bytes);
		loaded_count += is_loaded(folder.path / name);
	}
	CHECK(loaded_count > 100); // otherwise only the parser was tested
}

TEST_CASE("[GltfBadInput] primitives that share a large array only copy the vertices they use") {
	const GltfTestFolder folder;
	Json json = make_triangle(folder);
	json["accessors"][0] = { { "componentType", GLTF_TEST_FLOAT }, { "type", "VEC3" },
		{ "count", 1 << 22 } };
	const Json primitive = json["meshes"][0]["primitives"][0];
	for (int i = 1; i < 1000; ++i) {
		json["meshes"][0]["primitives"].push_back(primitive);
	}
	const auto scene = folder.load(json); // would take minutes if each copied 4 million vertices
	const auto meshes = scene->find_nodes<MeshInstance3D>();
	REQUIRE(meshes.size() == 1);
	REQUIRE(meshes[0]->surfaces.size() == 1000);
	CHECK(meshes[0]->surfaces[999].mesh->positions_node.size() == 3);
}

TEST_CASE("[GltfBadInput] shared definitions that would need too much memory are rejected") {
	const GltfTestFolder folder;
	Json json = make_triangle(folder);
	const Json primitive = json["meshes"][0]["primitives"][0];
	// 5000 primitives in 900 nodes exceed GLTF_MAX_SURFACE_COUNT, 2^22.
	for (int i = 1; i < 5000; ++i) {
		json["meshes"][0]["primitives"].push_back(primitive);
	}
	json.erase("scenes");
	json.erase("scene");
	json["nodes"] = Json::array();
	for (int i = 0; i < 900; ++i) {
		json["nodes"].push_back({ { "mesh", 0 } });
	}
	CHECK(get_load_error(folder, json).find("primitives in all nodes") != std::string::npos);

	Json lamps = make_spot_light_document();
	Json &light = lamps["extensions"]["KHR_lights_punctual"]["lights"][0];
	// 4000 values in 300 nodes exceed GLTF_MAX_LIGHT_VALUE_COUNT, 2^20.
	for (int i = 0; i < 4000; ++i) {
		light["extras"]["other_" + std::to_string(i)] = i;
	}
	const Json node = lamps["nodes"][0];
	lamps.erase("scenes");
	lamps.erase("scene");
	for (int i = 1; i < 300; ++i) {
		lamps["nodes"].push_back(node);
	}
	CHECK(get_load_error(folder, lamps).find("values in all nodes") != std::string::npos);
}
