#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_mesh_writer.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace gnomon {

/// Writes a scene's nodes, lights, cameras and size into a document's model: only what differs from
/// the loaded document, or everything if there is none.
class GltfNodeWriter {
public:
	/// p_document may be null. The arguments must outlive this object.
	GltfNodeWriter(
			const GltfDocument *p_document, tinygltf::Model &r_model, GltfMeshWriter &r_meshes) :
			document(p_document),
			model(r_model), meshes(r_meshes) {
		if (document) {
			mesh_indices = document->mesh_indices;
		}
	}
	void write(const Scene &p_scene);

private:
	/// A node of the scene and its index in the file.
	struct Entry {
		const Node3D *node = nullptr;
		size_t index = 0;
		bool is_new = false;
		/// Whether this is a light or camera that the file stores in its parent's node.
		bool is_attachment = false;
		std::vector<size_t> children;
	};
	/// What was written over existing light or camera definitions so far, by index in the file.
	template <typename T> using DefinitionMap = std::map<size_t, T>;

	/// Returns the entry's node in the document.
	tinygltf::Node &get_node(const Entry &p_entry) { return model.nodes[p_entry.index]; }
	std::optional<size_t> assign(const Node3D &p_node, const Entry *p_parent);
	bool is_attachment(const Node3D &p_node, const Entry *p_parent) const;
	void write_entry(const Entry &p_entry);
	void write_name(
			const Entry &p_entry, const std::string &p_before, tinygltf::Node &r_node) const;
	void write_mesh(const Entry &p_entry, const MeshInstance3D &p_instance);
	void write_motion(const tinygltf::Mesh &p_mesh, const MeshInstance3D &p_instance,
			tinygltf::Node &r_node) const;
	std::optional<size_t> find_or_append_mesh(
			const MeshInstance3D &p_instance, const GltfDocument::SurfaceKey &p_key);
	void write_node_light(const Entry &p_entry, const Light3D &p_light);
	void write_camera(const Entry &p_entry, const Camera3D &p_camera);
	tinygltf::Value *copy_area_light(tinygltf::Node &r_node);
	void remove_deleted_attachments();
	void detach_moved_children();
	void write_scene(const Scene &p_scene, const std::vector<size_t> &p_roots);
	template <typename T>
	static size_t store_definition(std::vector<T> &r_list, DefinitionMap<T> &r_written,
			std::optional<size_t> p_index, T p_definition);

	const GltfDocument *document;
	tinygltf::Model &model;
	GltfMeshWriter &meshes;
	/// Indices of the file's meshes, by their surfaces.
	std::map<GltfDocument::SurfaceKey, size_t> mesh_indices;
	std::vector<std::unique_ptr<Entry>> entries; // parents before their children
	std::set<size_t> used_nodes;				 // indices of the file's nodes that the scene uses
	std::set<size_t> mesh_nodes, light_nodes, camera_nodes; // indices of the nodes written so far
	DefinitionMap<tinygltf::Light> lights;
	DefinitionMap<tinygltf::Camera> cameras;
};

} // namespace gnomon
