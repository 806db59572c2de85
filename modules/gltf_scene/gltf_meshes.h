#pragma once

#include "modules/gltf_scene/gltf_accessors.h"
#include "modules/gltf_scene/gltf_materials.h"
#include "modules/gltf_scene/gltf_textures.h"
#include "modules/scene/mesh_rig.h"
#include "modules/scene/nodes.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// Reads meshes and their materials, each once. Strips and fans are converted to triangles. Points
/// and lines are not drawn: they are skipped with one warning.
class GltfMeshes {
public:
	/// Reads and checks all materials of p_root, the document's JSON. The arguments must outlive
	/// this object.
	GltfMeshes(const GltfObject &p_root, const tinygltf::Model &p_model, GltfAccessors &p_accessors,
			GltfTextures &p_textures);

	/// Returns one surface per primitive that has triangles. Its mesh may contain vertices that no
	/// triangle uses, if it has at least as many indices as vertices.
	const std::vector<MeshInstance3D::Surface> &load_mesh(size_t p_index);
	/// Returns the materials loaded so far, by index in the file.
	const std::map<size_t, std::shared_ptr<const Material>> &get_materials() const {
		return materials;
	}
	/// Returns the primitive index of each loaded mesh.
	const std::map<const Mesh *, size_t> &get_primitive_indices() const {
		return primitive_indices;
	}

private:
	/// Returns null if the primitive has no triangles. p_path: its JSON path.
	std::shared_ptr<const Mesh> load_primitive(const tinygltf::Primitive &p_primitive,
			const std::string &p_path, const Material &p_material, std::string p_name,
			bool p_has_skin);
	/// Throws an Error if a position is not finite. Each accessor is checked only once.
	void check_finite(size_t p_accessor_index, const std::vector<glm::vec3> &p_positions,
			const std::string &p_path, const std::string &p_name);
	/// Reads the vertex colours, and the texture coordinates and tangents that the material uses.
	/// Values that are not finite become 0. p_count: number of vertices.
	MeshAttributes read_attributes(const tinygltf::Primitive &p_primitive,
			const std::string &p_path, const Material &p_material, size_t p_count);
	/// Adds the size of the rig's morph targets to target_vector_count. Throws an Error if that
	/// exceeds GLTF_MAX_VERTEX_COUNT.
	void check_target_limit(const MeshRig &p_rig, const std::string &p_path);
	std::shared_ptr<const Material> load_material(const tinygltf::Primitive &p_primitive);

	const tinygltf::Model &model;
	GltfAccessors &accessors;
	GltfTextures &textures;
	GltfMessages &messages;
	std::map<size_t, std::vector<MeshInstance3D::Surface>> meshes;
	std::vector<GltfMaterial> read_materials; // all of the file, by index
	std::map<size_t, std::shared_ptr<const Material>> materials;
	std::map<const Mesh *, size_t> primitive_indices;
	std::shared_ptr<const Material> default_material = std::make_shared<const Material>();
	std::set<size_t> finite_accessors; // accessors whose positions have been checked
	uint64_t vertex_count = 0;		   // of all meshes so far
	uint64_t index_count = 0;		   // of all meshes so far
	uint64_t target_vector_count = 0;  // in the morph targets of all meshes so far
	std::set<int> skinned_meshes;	   // indices of the meshes of nodes that have a skin
};

} // namespace gnomon
