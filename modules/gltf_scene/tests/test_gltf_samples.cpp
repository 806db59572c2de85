// Tests loading and saving with the glTF files of the Debian package assimp-testmodels.

#include "modules/gltf_scene/tests/gltf_test_files.h"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <set>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

const char MODELS[] = "/usr/share/assimp/models";

/// Files of the package that must be rejected: glTF 1.0, unsupported extensions that change the
/// geometry, and files that are invalid on purpose.
const std::set<std::string> REFUSED = {
	"glTF/BoxTextured-glTF-Binary/BoxTextured.glb",
	"glTF/BoxTextured-glTF-Embedded/BoxTextured.gltf",
	"glTF/BoxTextured-glTF-MaterialsCommon/BoxTextured.gltf",
	"glTF/BoxTextured-glTF/BoxTextured.gltf",
	"glTF/CesiumMilkTruck/CesiumMilkTruck.gltf",
	"glTF/IncorrectVertexArrays/Cube_v1.gltf",
	"glTF/TwoBoxes/TwoBoxes.gltf",
	"glTF2/BoxTextured-glTF-techniqueWebGL/BoxTextured.gltf",
	"glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb",
	"glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf",
	"glTF2/IndexOutOfRange/IndexOutOfRange.gltf",
	"glTF2/MissingBin/BoxTextured.gltf",
	"glTF2/RecursiveNodes/RecursiveNodes.gltf",
	"glTF2/SchemaFailures/sceneWrongType.gltf",
	"glTF2/draco/2CylinderEngine.gltf",
	"glTF2/wrongTypes/badArray.gltf",
	"glTF2/wrongTypes/badObject.gltf",
};

size_t count_triangles(const Scene &p_scene) {
	size_t count = 0;
	for (const MeshInstance3D *instance : p_scene.find_nodes<MeshInstance3D>()) {
		for (const MeshInstance3D::Surface &surface : instance->surfaces) {
			count += surface.mesh->get_triangle_count();
		}
	}
	return count;
}

} // namespace

TEST_CASE("[GltfSamples] each file of assimp-testmodels loads and saves, unless it is in REFUSED") {
	REQUIRE_MESSAGE(fs::is_directory(MODELS),
			"the sample files are missing: install the package assimp-testmodels");
	GltfTestLog log;
	GltfTestFolder folder;
	size_t loaded_count = 0;
	size_t refused_count = 0;
	for (const auto &entry : fs::recursive_directory_iterator(MODELS)) {
		const std::string extension = entry.path().extension().string();
		if (extension != ".gltf" && extension != ".glb") {
			continue;
		}
		const std::string name = fs::relative(entry.path(), MODELS).generic_string();
		CAPTURE(name);
		try {
			const auto scene = load_gltf(entry.path());
			++loaded_count;
			CHECK_FALSE(REFUSED.contains(name));
			for (const char *copy : { "copy.gltf", "copy.glb" }) {
				save_gltf(*scene, folder.path / copy);
				CHECK(find_difference(*scene, *load_gltf(folder.path / copy)) == "");
			}
			// Saves the scene and its source path for tests/gltf/test_validator.py.
			if (const char *saved = std::getenv("GNOMON_SAVED_FOLDER")) {
				save_gltf(*scene, fs::path(saved) / (std::to_string(loaded_count) + ".glb"));
				std::ofstream(fs::path(saved) / (std::to_string(loaded_count) + ".txt"))
						<< entry.path().string();
			}
		} catch (const Error &error) {
			const std::string message = error.what();
			CAPTURE(message);
			++refused_count;
			CHECK(REFUSED.contains(name));
			CHECK(message.find(entry.path().filename().string()) != std::string::npos);
			CHECK(message.find('\n') == std::string::npos);
		}
	}
	CHECK(loaded_count >= 30); // 36 in version 5.2.5 of the package
	CHECK(refused_count == REFUSED.size());
}

TEST_CASE("[GltfSamples] sample files have the expected number of triangles and cameras") {
	REQUIRE_MESSAGE(fs::is_directory(MODELS),
			"the sample files are missing: install the package assimp-testmodels");
	GltfTestLog log;
	const fs::path folder = fs::path(MODELS) / "glTF2";
	CHECK(count_triangles(*load_gltf(
				  folder / "2CylinderEngine-glTF-Binary" / "2CylinderEngine.glb")) == 121496);
	// Its second camera is orthographic, which is not read.
	CHECK(load_gltf(folder / "cameras" / "Cameras.gltf")->find_nodes<Camera3D>().size() == 1);
	const fs::path modes = folder / "glTF-Asset-Generator" / "Mesh_PrimitiveMode";
	// A square of two triangles, as a list, strip or fan, with and without indices.
	for (const char *number : { "04", "05", "06", "11", "12", "13", "14", "15" }) {
		CHECK(count_triangles(*load_gltf(
					  modes / ("Mesh_PrimitiveMode_" + std::string(number) + ".gltf"))) == 2);
	}
}
