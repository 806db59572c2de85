// What saving preserves of the text of a file: all of it if the scene is unchanged, else everything
// but the changed values.

#include "modules/gltf_scene/gltf_json_text.h"
#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

#include <random>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

/// Loads each glTF file below p_folder, saves it next to itself under another name and compares
/// both files. Files that cannot be loaded are skipped. Returns the number of files compared.
size_t compare_saved_files(const fs::path &p_folder) {
	REQUIRE_MESSAGE(fs::is_directory(p_folder), p_folder.string(), " does not exist");
	GltfTestFolder copies; // the files and their side files, because saving needs a folder to write
	fs::copy(p_folder, copies.path / "models", fs::copy_options::recursive);
	std::vector<fs::path> paths;
	for (const auto &entry : fs::recursive_directory_iterator(copies.path)) {
		const std::string extension = entry.path().extension().string();
		if (extension == ".gltf" || extension == ".glb") {
			paths.push_back(entry.path());
		}
	}
	size_t count = 0;
	for (const fs::path &path : paths) {
		const std::string name = fs::relative(path, copies.path).generic_string();
		CAPTURE(name);
		std::unique_ptr<Scene> scene;
		try {
			scene = load_gltf(path);
		} catch (const Error &) {
			continue;
		}
		const std::vector<uint8_t> before = load_file(path);
		const fs::path saved = path.parent_path() / ("saved" + path.extension().string());
		save_gltf(*scene, saved);
		CHECK(load_file(saved) == before);
		save_gltf(*scene, path);
		CHECK(load_file(path) == before);
		++count;
	}
	return count;
}

/// Changes a few random elements of the JSON: removes, replaces or adds one.
void change_randomly(Json &r_json, std::mt19937 &r_random) {
	const Json values[] = { 7, "\"new\"", Json::array(),
		Json::parse(R"({"a": [1, {"b": null}]})") };
	const Json &value = values[r_random() % std::size(values)];
	if (!r_json.is_structured() || r_json.empty() || r_random() % 8 == 0) {
		r_json = value;
		return;
	}
	const auto item = std::next(r_json.begin(), std::ptrdiff_t(r_random() % r_json.size()));
	const unsigned choice = r_random() % 8;
	if (choice == 0) {
		r_json.erase(item);
	} else if (choice == 1 && r_json.is_array()) {
		r_json.push_back(value);
	} else if (choice == 1) {
		r_json["new \"\\"] = value;
	} else {
		change_randomly(*item, r_random);
	}
}

} // namespace

// The paths are relative to the root of the repository, in which tests run.
TEST_CASE("[GltfUntouched] saving an untouched file gives equal bytes") {
	GltfTestLog log;
	CHECK(compare_saved_files("demo_project/scenes") >= 12);
	CHECK(compare_saved_files("demo_project/godot") >= 1);
	CHECK(compare_saved_files("modules/gltf_scene/tests") == 1); // an export from Blender
	CHECK(compare_saved_files("tests/fuzz/corpus/gltf") >= 25);
	CHECK(compare_saved_files("/usr/share/assimp/models") >= 30); // package assimp-testmodels
}

TEST_CASE("[GltfUntouched] any layout of the text is preserved: spaces, number formats, byte order "
		  "mark") {
	GltfTestFolder folder;
	GltfTestLog log;
	const std::string text = "\xEF\xBB\xBF{ \"asset\" :{\"version\":\"2.0\"},\r\n"
							 "  \"nodes\": [ {\"name\": \"\\u0041\", \"children\": [ 1.0 ], "
							 "\"translation\": [1e0, 2.50, -0]},{}],\t\"extras\": null }\n\n";
	folder.write("scene.gltf", text);
	save_gltf(*load_gltf(folder.path / "scene.gltf"), folder.path / "again.gltf");
	CHECK(load_text_file(folder.path / "again.gltf") == text);
}

TEST_CASE("[GltfUntouched] a changed value changes nothing else in the text") {
	GltfTestFolder folder;
	GltfTestLog log;
	const std::string before = "{\r\n  \"asset\": {\"version\": \"2.0\"},\r\n"
							   "  \"scene\": 0, \"scenes\": [ { \"nodes\": [0,1] } ],\r\n"
							   "  \"nodes\": [\r\n"
							   "    {\"name\": \"\\u0041\", \"translation\": [1e0, 2.50, -0]},\r\n"
							   "    {\r\n      \"name\": \"B\" ,\r\n      \"x\": 1.10\r\n    }\r\n"
							   "  ]\r\n}\r\n";
	folder.write("scene.gltf", before);
	const auto scene = load_gltf(folder.path / "scene.gltf");
	scene->root->children[0]->parent_from_node[3].y = 3.5;
	scene->root->children[1]->name = "C";
	scene->root->children[1]->parent_from_node[3].x = 1;
	scene->scene_size_m = 4;
	save_gltf(*scene, folder.path / "scene.gltf");
	std::string expected = before;
	const auto replace = [&](const std::string &p_old, const std::string &p_new) {
		expected.replace(expected.find(p_old), p_old.size(), p_new);
	};
	replace("2.50", "3.5");
	replace("\"B\" ", "\"C\" ");
	replace("1.10",
			"1.10,\r\n      \"translation\": [\r\n        1.0,\r\n        0.0,\r\n"
			"        0.0\r\n      ]");
	replace("[0,1] }", "[0,1], \"extras\": {\"scene_size\":4.0} }");
	CHECK(load_text_file(folder.path / "scene.gltf") == expected);
}

TEST_CASE("[GltfUntouched] after random changes the text has the changed value") {
	std::mt19937 random(20261201); // any fixed seed
	size_t count = 0;
	for (const auto &entry : fs::directory_iterator("demo_project/scenes")) {
		if (entry.path().extension() != ".gltf") {
			continue;
		}
		const std::string text = load_text_file(entry.path());
		const Json before = Json::parse(text);
		CHECK(update_json_text(text, before, before) == text);
		for (int round = 0; round < 60; ++round) {
			CAPTURE(round);
			const std::string start = round % 2 == 0 ? text : before.dump(); // without lines
			Json after = before;
			for (unsigned change = 0; change <= random() % 4; ++change) {
				change_randomly(after[round % 3 == 0 ? "nodes" : "materials"], random);
			}
			const std::string changed = update_json_text(start, before, after);
			CHECK(sort_keys(Json::parse(changed)) == sort_keys(after));
			++count;
		}
	}
	CHECK(count > 600);
	const std::string twice = R"({"a": {"b": 1, "b": 2, "c": 3}, "d" : [ ]})";
	const Json before = Json::parse(twice);
	Json after = before;
	after["a"]["c"] = 4;
	CHECK(update_json_text(twice, before, after) == R"({"a": {"b":2,"c":4}, "d" : [ ]})");
}
