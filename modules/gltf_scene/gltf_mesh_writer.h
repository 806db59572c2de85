#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/scene/nodes.h"

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// Writes new meshes and new or changed materials into a document's JSON, each once. The vertex
/// and index bytes are collected for one buffer, which the caller stores.
class GltfMeshWriter {
public:
	/// p_document: the document that the scene was loaded from; may be null. p_loaded: its JSON as
	/// read. r_root: a copy of it, or the JSON of a new document, which is changed. p_buffer_index,
	/// p_first_byte: index of the buffer that will hold the bytes, and their offset in it. p_used:
	/// the materials of the scene that is written. The document and the JSON must outlive this
	/// object.
	GltfMeshWriter(const GltfDocument *p_document, const Json &p_loaded, Json &r_root,
			size_t p_buffer_index, size_t p_first_byte, std::set<const Material *> p_used);
	/// Writes a new mesh, at rest and without textures, and returns its index. At least one of
	/// p_surfaces has triangles.
	size_t append_mesh(
			const std::string &p_name, const std::vector<MeshInstance3D::Surface> &p_surfaces);
	/// Like append_mesh, for a mesh that differs from one of the document only in its materials.
	/// The new mesh shares the accessors and has all data unknown to the program. If no material
	/// index changes, returns the index of the existing mesh. Returns nothing if the document has
	/// no such mesh.
	std::optional<size_t> change_materials(const std::vector<MeshInstance3D::Surface> &p_surfaces);
	const std::vector<uint8_t> &get_bytes() const { return bytes; }

private:
	struct Accessors {
		Json attributes = Json::object(); // indices by glTF's name of the attribute
		size_t indices = 0;
	};
	Accessors append_vertices(const Mesh &p_mesh);
	size_t append_accessor(std::span<const uint8_t> p_data, Json p_accessor, int p_target);
	/// Writes a material if needed and returns its index. A changed material replaces its original
	/// in the file, unless the scene uses the original, a node that is not loaded may use it
	/// (shares_materials), or a different material has replaced it already: then it is appended.
	size_t store_material(const Material &p_material);

	std::optional<size_t> find_loaded_mesh(
			const std::vector<MeshInstance3D::Surface> &p_surfaces) const;

	const GltfDocument *document;
	const Json &loaded;
	Json &root;
	size_t buffer_index;
	size_t first_byte;
	std::vector<uint8_t> bytes;
	std::map<const Mesh *, Accessors> accessors;
	std::map<const Material *, size_t> material_indices;
	/// The materials as loaded, by index in the file; null if the loaded scene did not use one.
	std::vector<const Material *> original_materials;
	std::set<const Material *> used;	// by the scene that is written
	std::set<size_t> replaced;			// indices of the file's materials that were replaced
	std::vector<size_t> changed_meshes; // indices of the meshes that change_materials appended
};

} // namespace gnomon
