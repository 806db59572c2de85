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
	/// Files outside this folder are rejected, even if a URI or a symbolic link leads to them.
	/// Empty: the scene's folder.
	std::filesystem::path project_folder;
	/// Finds a technique's property by its full name ("<id>_<name>"), or returns null. Properties
	/// that are found are checked and converted; others are preserved as they are. May be empty.
	std::function<const PropertyInfo *(std::string_view)> find_technique_property;
};

/// Reads a .gltf or .glb (2.0) file: its default scene, else its first scene, else all nodes
/// without a parent. Throws an Error if the file cannot be drawn as intended; its message is one
/// line with file, JSON path, value, range and next step. An invalid value of a light, camera,
/// material or texture is logged as an error in the same form, and its default is used; an
/// animation channel or an image that cannot be read is logged and skipped. KHR_animation_pointer
/// is not supported; one warning reports it.
std::unique_ptr<Scene> load_gltf(
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options = {});
/// Like load_gltf, for the bytes of a file. p_path: location of the file, for messages and for
/// resolving the files that it references. The file itself need not exist.
std::unique_ptr<Scene> parse_gltf(std::span<const uint8_t> p_bytes,
		const std::filesystem::path &p_path, const GltfLoadOptions &p_options = {});

/// Writes the scene, in binary form if the name ends in .glb and as text if it ends in .gltf. If
/// the scene was loaded from a file of the same form, only changed values are rewritten in its
/// text, and an unchanged scene gives equal bytes. Data unknown to the program is preserved, except
/// chunks of a .glb other than JSON and BIN, which a .gltf cannot hold. The file is replaced
/// atomically, after the files that it references. Throws an Error if a value is not finite or if a
/// file cannot be written.
///
/// If the scene is saved in another folder, the buffer and image files are copied next to the new
/// file. A copy gets a number if its name belongs to a file with other content. Meshes that were
/// not loaded from the file are stored in <name>.bin next to the .gltf, or inside the .glb.
void save_gltf(const Scene &p_scene, const std::filesystem::path &p_path);

} // namespace gnomon
