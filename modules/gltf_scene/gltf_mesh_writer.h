#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/scene/nodes.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// Writes new meshes and new or changed materials into a document's model, each once. Their bytes
/// are collected for one buffer, which the caller stores.
class GltfMeshWriter {
public:
	/// p_buffer_index, p_first_byte: where the bytes will be. p_document may be null. p_used:
	/// the materials of the scene that is written. r_model and p_document must outlive it.
	GltfMeshWriter(tinygltf::Model &r_model, size_t p_buffer_index, size_t p_first_byte,
			const GltfDocument *p_document, std::set<const Material *> p_used);
	/// Writes a new mesh and returns its index. p_surfaces is not empty.
	size_t append_mesh(
			const std::string &p_name, const std::vector<MeshInstance3D::Surface> &p_surfaces);
	/// Like append_mesh, for a mesh that differs from one of the document only in its materials:
	/// its vertices, and all data that the program does not understand, stay. If the material
	/// indices do not change either, the existing mesh is returned. Nothing: the document has no
	/// such mesh.
	std::optional<size_t> change_materials(const std::vector<MeshInstance3D::Surface> &p_surfaces);
	const std::vector<uint8_t> &get_bytes() const { return bytes; }

private:
	struct Accessors {
		int positions = 0;
		int normals = 0;
		int indices = 0;
	};
	Accessors append_vertices(const Mesh &p_mesh);
	int append_accessor(
			std::span<const uint8_t> p_data, tinygltf::Accessor p_accessor, int p_target);
	/// Returns the index of the material. A changed material replaces the one it was copied from if
	/// neither the scene nor a node that is not loaded may use that (shares_materials) and no
	/// different copy has replaced it; otherwise it is appended.
	size_t put_material(const Material &p_material);

	std::optional<size_t> find_loaded_mesh(
			const std::vector<MeshInstance3D::Surface> &p_surfaces) const;

	tinygltf::Model &model;
	const GltfDocument *document;
	size_t buffer_index;
	size_t first_byte;
	std::vector<uint8_t> bytes;
	std::map<const Mesh *, Accessors> accessors;
	std::map<const Material *, size_t> material_indices;
	/// By index in the file; null: not used by the scene.
	std::vector<const Material *> loaded_materials;
	std::set<const Material *> used;
	std::map<size_t, tinygltf::Material> replaced; // the replaced materials as loaded
	std::vector<size_t> changed_meshes;
};

} // namespace gnomon
