#pragma once

#include "modules/gltf_scene/gltf_accessors.h"
#include "modules/gltf_scene/gltf_textures.h"
#include "modules/scene/mesh_rig.h"
#include "modules/scene/nodes.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace gnomon {

/// Reads meshes and their materials, each once. Triangles, strips and fans become triangles; points
/// and lines have no shadow here and are skipped with one warning.
class GltfMeshes {
public:
	/// The arguments must outlive this object.
	GltfMeshes(const tinygltf::Model &p_model, GltfAccessors &p_accessors, GltfTextures &p_textures,
			GltfMessages &r_messages);

	/// One surface per primitive with triangles.
	const std::vector<MeshInstance3D::Surface> &load_mesh(size_t p_index);
	const std::map<size_t, std::shared_ptr<const Material>> &get_materials() const {
		return materials;
	}
	/// Returns the primitive index of each loaded mesh.
	const std::map<const Mesh *, size_t> &get_primitive_indices() const {
		return primitive_indices;
	}

private:
	/// p_path: JSON path of the primitive.
	std::shared_ptr<const Mesh> load_primitive(const tinygltf::Primitive &p_primitive,
			const std::string &p_path, const Material &p_material, std::string p_name,
			bool p_has_skin);
	/// Fails on a position that is not finite. Each accessor is checked only once.
	void check_finite(size_t p_accessor_index, const std::vector<glm::vec3> &p_positions,
			const std::string &p_path, const std::string &p_name);
	/// Reads the vertex attributes that the material uses. p_count: number of vertices.
	MeshAttributes read_attributes(const tinygltf::Primitive &p_primitive,
			const std::string &p_path, const Material &p_material, size_t p_count);
	/// Adds up the size of all morph targets, and fails above the limit.
	void count_targets(const MeshRig &p_rig, const std::string &p_path);
	std::shared_ptr<const Material> load_material(const tinygltf::Primitive &p_primitive);

	const tinygltf::Model &model;
	GltfAccessors &accessors;
	GltfTextures &textures;
	GltfMessages &messages;
	std::map<size_t, std::vector<MeshInstance3D::Surface>> meshes;
	std::map<size_t, std::shared_ptr<const Material>> materials;
	std::map<const Mesh *, size_t> primitive_indices;
	std::shared_ptr<const Material> default_material = std::make_shared<const Material>();
	std::set<size_t> finite_accessors; // accessors whose positions have been checked
	uint64_t vertex_count = 0;		   // of all meshes so far, as is the count of indices
	uint64_t index_count = 0;
	uint64_t target_value_count = 0; // vectors of morph targets
	std::set<int> skinned_meshes;	 // meshes that some node shows with a skin
};

} // namespace gnomon
