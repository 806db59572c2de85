#pragma once

#include "modules/core/property.h"
#include "modules/scene/nodes.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

namespace gnomon {

struct GltfLoadOptions {
	/// Files outside this folder are refused, even if a URI or symbolic link names them. Empty =
	/// the scene's folder.
	std::filesystem::path project_folder;
	/// Finds a technique's property by its full name ("<id>_<name>"), or returns null. Properties
	/// that are found are checked and converted; others are preserved as they are. May be empty.
	std::function<const PropertyInfo *(std::string_view)> find_technique_property;
};

/// Reads a .gltf or .glb (2.0) file: its default scene, else the first, else all nodes without a
/// parent. Anything that cannot be drawn as meant is an Error of one line with file, JSON path,
/// value, range and next step. A refused value of a light, camera or material is logged as an error
/// in the same words, and its default used. KHR_animation_pointer is not
/// read; one warning reports it.
std::unique_ptr<Scene> load_gltf(
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options = {});
/// Parses the bytes of a file. p_path: location of the file, for messages and for the files that it
/// references; it need not exist.
std::unique_ptr<Scene> parse_gltf(std::span<const uint8_t> p_bytes,
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options = {});

/// Writes the scene, as binary if the name ends in .glb. A scene that was loaded from a file keeps
/// all data of it that the program does not understand; only changes are rewritten. The file is
/// replaced atomically, after the files that it references.
///
/// If the scene is saved in another folder, buffers and images next to the old file are copied next
/// to the new one (never over a file with other content: the copy then gets a number). A scene
/// without a source file gets its vertices in <name>.bin next to the .gltf, or inside the .glb.
void save_gltf(const Scene &p_scene, const std::filesystem::path &p_path);

} // namespace gnomon
