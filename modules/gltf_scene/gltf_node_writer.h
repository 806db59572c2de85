#pragma once

#include "modules/gltf_scene/gltf_document.h"
#include "modules/gltf_scene/gltf_mesh_writer.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace gnomon {

/// Writes a scene's nodes, lights, cameras and size into a document's JSON: what differs from the
/// document that was loaded, or all where there is none.
class GltfNodeWriter {
public:
	/// p_document may be null. All must outlive it.
	GltfNodeWriter(const GltfDocument *p_document, Json &r_json, GltfMeshWriter &r_meshes) :
			document(p_document), json(r_json), meshes(r_meshes) {
		if (document) {
			mesh_indices = document->mesh_indices;
		}
	}
	void write(const Scene &p_scene);

private:
	/// Where a node of the scene stands in the file.
	struct Entry {
		const Node3D *node = nullptr;
		size_t index = 0;
		bool is_new = false;
		bool is_part = false; // a light or camera of a node that is also something else
		std::vector<size_t> children;
	};
	/// Definitions that nodes share: written once per value.
	using Written = std::map<size_t, Json>;

	/// The node in the document. Fetched anew after every change elsewhere: a key that is added to
	/// an ordered object moves all its values.
	Json &get_node(const Entry &p_entry) { return json["nodes"][p_entry.index]; }
	std::optional<size_t> assign(const Node3D &p_node, const Entry *p_parent);
	bool is_part(const Node3D &p_node, const Entry *p_parent) const;
	void write_entry(const Entry &p_entry);
	void write_name(const Entry &p_entry, const std::string &p_before, Json &r_node) const;
	void write_children(const Entry &p_entry, Json &r_node) const;
	void write_mesh(const Entry &p_entry, const MeshInstance3D &p_instance);
	std::optional<size_t> find_or_append_mesh(
			const MeshInstance3D &p_instance, const GltfDocument::SurfaceKey &p_key);
	void write_light_of(const Entry &p_entry, const Light3D &p_light);
	void write_camera(const Entry &p_entry, const Camera3D &p_camera);
	Json *own_area_light(Json &r_node);
	void drop_lost_parts();
	void drop_lost_children();
	void write_scene(const Scene &p_scene, const std::vector<size_t> &p_roots);
	static size_t place_definition(
			Json &r_list, Written &r_written, std::optional<size_t> p_index, Json p_definition);

	const GltfDocument *document;
	Json &json;
	GltfMeshWriter &meshes;
	std::map<GltfDocument::SurfaceKey, size_t> mesh_indices;
	std::vector<std::unique_ptr<Entry>> entries; // parents before their children
	std::set<size_t> taken;						 // nodes of the file that the scene still has
	std::set<size_t> mesh_nodes, light_nodes, camera_nodes;
	Written lights, cameras;
};

} // namespace gnomon
