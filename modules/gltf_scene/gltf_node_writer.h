#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_mesh_writer.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace gnomon {

/// Writes a scene's nodes, lights, cameras and size into a document's JSON: only what differs from
/// the loaded document, or everything if there is none.
class GltfNodeWriter {
public:
	/// p_document may be null. p_loaded: its JSON as read. r_root: a copy of it, or the JSON of a
	/// new document, which is changed. The arguments must outlive this object.
	GltfNodeWriter(const GltfDocument *p_document, const Json &p_loaded, Json &r_root,
			GltfMeshWriter &r_meshes) :
			document(p_document),
			loaded(p_loaded), root(r_root), meshes(r_meshes) {
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
	using DefinitionMap = std::map<size_t, Json>;

	/// Returns the entry's node in the document.
	Json &get_node(const Entry &p_entry) { return root["nodes"][p_entry.index]; }
	std::optional<size_t> assign(const Node3D &p_node, const Entry *p_parent);
	bool is_attachment(const Node3D &p_node, const Entry *p_parent) const;
	void write_entry(const Entry &p_entry);
	void write_name(const Entry &p_entry, const std::string &p_before, Json &r_node) const;
	void write_mesh(const Entry &p_entry, const MeshInstance3D &p_instance);
	void write_motion(const Json &p_mesh, const MeshInstance3D &p_instance, Json &r_node) const;
	std::optional<size_t> find_or_append_mesh(
			const MeshInstance3D &p_instance, const GltfDocument::SurfaceKey &p_key);
	void write_node_light(const Entry &p_entry, const Light3D &p_light);
	void write_camera(const Entry &p_entry, const Camera3D &p_camera);
	Json *copy_area_light(Json &r_node);
	void remove_deleted_attachments();
	void detach_moved_children();
	void write_scene(const Scene &p_scene, const std::vector<size_t> &p_roots);
	static size_t store_definition(Json &r_parent, const char *p_list, DefinitionMap &r_written,
			std::optional<size_t> p_index, Json p_definition);

	const GltfDocument *document;
	const Json &loaded;
	Json &root;
	GltfMeshWriter &meshes;
	/// Indices of the file's meshes, by their surfaces.
	std::map<GltfDocument::SurfaceKey, size_t> mesh_indices;
	std::vector<std::unique_ptr<Entry>> entries; // parents before their children
	std::set<size_t> used_nodes;				 // indices of the file's nodes that the scene uses
	std::set<size_t> mesh_nodes, light_nodes, camera_nodes; // indices of the nodes written so far
	DefinitionMap lights;
	DefinitionMap cameras;
};

} // namespace gnomon
