#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_json.h"
#include "modules/scene/nodes.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// Writes new meshes and new or changed materials into a document's JSON, each once. Their bytes
/// are collected for one buffer, which the caller stores.
class GltfMeshWriter {
public:
	/// p_buffer_index, p_first_byte: where the bytes will stand. p_document may be null. p_used:
	/// the materials of the scene that is written. r_json and p_document must outlive it.
	GltfMeshWriter(Json &r_json, size_t p_buffer_index, size_t p_first_byte,
			const GltfDocument *p_document, std::set<const Material *> p_used);
	/// Index of the new mesh. p_surfaces is not empty.
	size_t append_mesh(
			const std::string &p_name, const std::vector<MeshInstance3D::Surface> &p_surfaces);
	/// As append_mesh where the document has a mesh that differs in its materials alone: its
	/// vertices and all that the program does not understand stay. Where the materials stay in
	/// their places, it is that mesh itself. None: there is no such mesh.
	std::optional<size_t> change_materials(const std::vector<MeshInstance3D::Surface> &p_surfaces);
	const std::vector<uint8_t> &get_bytes() const { return bytes; }

private:
	struct Accessors {
		size_t positions = 0;
		size_t normals = 0;
		size_t indices = 0;
	};
	Accessors append_vertices(const Mesh &p_mesh);
	size_t append_accessor(
			std::span<const uint8_t> p_data, size_t p_count, Json p_accessor, int p_target);
	/// Index of the material. A changed one takes the place of that it came from, where the scene
	/// does not use that any more; else it is appended.
	size_t place_material(const Material &p_material);

	std::optional<size_t> find_loaded_mesh(
			const std::vector<MeshInstance3D::Surface> &p_surfaces) const;

	Json &json;
	const GltfDocument *document;
	size_t buffer_index;
	size_t first_byte;
	std::vector<uint8_t> bytes;
	std::map<const Mesh *, Accessors> accessors;
	std::map<const Material *, size_t> material_indices;
	std::vector<const Material *> loaded_materials; // by index in the file; null: not used there
	std::set<const Material *> used;
	std::map<size_t, Json> replaced; // definitions that took the place of loaded ones
	std::map<Json, size_t> changed_meshes;
};

} // namespace gnomon
