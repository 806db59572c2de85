// Saving a scene that nobody changed writes the bytes that were read.

#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

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

TEST_CASE(
		"[GltfUntouched] any layout of the text is kept: spaces, number formats, byte order mark") {
	GltfTestFolder folder;
	GltfTestLog log;
	const std::string text = "\xEF\xBB\xBF{ \"asset\" :{\"version\":\"2.0\"},\r\n"
							 "  \"nodes\": [ {\"name\": \"\\u0041\", \"children\": [ 1.0 ], "
							 "\"translation\": [1e0, 2.50, -0]},{}],\t\"extras\": null }\n\n";
	folder.write("scene.gltf", text);
	save_gltf(*load_gltf(folder.path / "scene.gltf"), folder.path / "again.gltf");
	CHECK(load_text_file(folder.path / "again.gltf") == text);
}
