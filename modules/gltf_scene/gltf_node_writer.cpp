#include "modules/gltf_scene/gltf_node_writer.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/gltf_scene/gltf_edit.h"
#include "modules/gltf_scene/gltf_tree.h"

#include <algorithm>
#include <cmath>
#include <typeinfo>

namespace gnomon {

namespace {

/// Returns whether a node is saved: all nodes are, except staged ones (Node3D::is_staged) without
/// saved descendants.
bool is_saved(const Node3D &p_node) {
	return !p_node.is_staged ||
			std::any_of(p_node.children.begin(), p_node.children.end(),
					[](const std::unique_ptr<Node3D> &p_child) { return is_saved(*p_child); });
}

} // namespace

void GltfNodeWriter::write(const Scene &p_scene) {
	std::vector<size_t> roots;
	const Node3D &scene_root = *p_scene.root;
	if (typeid(scene_root) != typeid(Node3D) || scene_root.parent_from_node != glm::dmat4(1.0)) {
		roots.push_back(*assign(scene_root, nullptr)); // it has data, so it becomes a node
	} else {
		for (const std::unique_ptr<Node3D> &child : scene_root.children) {
			if (is_saved(*child)) {
				roots.push_back(*assign(*child, nullptr));
			}
		}
	}
	for (const std::unique_ptr<Entry> &entry : entries) {
		write_entry(*entry);
	}
	if (document) {
		remove_deleted_attachments();
		detach_moved_children();
	}
	write_scene(p_scene, roots);
}

/// Returns whether the node is a light or camera that stays stored in its parent's node of the
/// file.
bool GltfNodeWriter::is_attachment(const Node3D &p_node, const Entry *p_parent) const {
	if (!document || !p_parent || p_parent->is_new || p_node.file_index < 0 ||
			static_cast<size_t>(p_node.file_index) != p_parent->index || !p_node.children.empty() ||
			p_node.parent_from_node != glm::dmat4(1.0)) {
		return false; // it was moved or has children, so it needs its own node
	}
	const auto names = document->attachment_names.find(p_parent->index);
	if (names == document->attachment_names.end() || !names->second.contains(p_node.name)) {
		return false; // it was renamed, and only its own node can store the name
	}
	return (dynamic_cast<const Light3D *>(&p_node) && document->lights.contains(p_parent->index)) ||
			(dynamic_cast<const Camera3D *>(&p_node) &&
					document->cameras.contains(p_parent->index));
}

/// Finds or creates the node of the file for a node of the scene and its descendants. Returns its
/// index; nothing if the node is stored in its parent's node (is_attachment).
std::optional<size_t> GltfNodeWriter::assign(const Node3D &p_node, const Entry *p_parent) {
	Entry &entry = *entries.emplace_back(std::make_unique<Entry>());
	entry.node = &p_node;
	entry.is_attachment = is_attachment(p_node, p_parent);
	if (entry.is_attachment) {
		entry.index = p_parent->index;
		return std::nullopt;
	}
	const size_t file_index = static_cast<size_t>(p_node.file_index);
	const bool is_in_file = document && p_node.file_index >= 0 &&
			file_index < document->nodes.size() && document->nodes[file_index].is_loaded &&
			used_nodes.insert(file_index).second;
	entry.is_new = !is_in_file;
	entry.index = file_index;
	if (entry.is_new) {
		entry.index = append_element(root, "nodes", Json::object());
		used_nodes.insert(entry.index);
	}
	for (const std::unique_ptr<Node3D> &child : p_node.children) {
		if (!is_saved(*child)) {
			continue;
		}
		if (const std::optional<size_t> index = assign(*child, &entry)) {
			entry.children.push_back(*index);
		}
	}
	return entry.index;
}

void GltfNodeWriter::write_entry(const Entry &p_entry) {
	const Node3D &node = *p_entry.node;
	Json &target = get_node(p_entry);
	if (!p_entry.is_attachment) {
		const GltfNodeState defaults;
		const GltfNodeState &before = p_entry.is_new ? defaults : document->nodes[p_entry.index];
		write_name(p_entry, before.name, target);
		if (node.parent_from_node != before.parent_from_node) {
			write_transform(node, before.parent_from_node, target);
		}
		write_indices(target, "children", p_entry.children);
	}
	if (const auto *instance = dynamic_cast<const MeshInstance3D *>(&node)) {
		write_mesh(p_entry, *instance);
	} else if (const auto *light = dynamic_cast<const Light3D *>(&node)) {
		write_node_light(p_entry, *light);
	} else if (const auto *camera = dynamic_cast<const Camera3D *>(&node)) {
		write_camera(p_entry, *camera);
	}
}

/// Writes a changed name. The node of a light from an older Blender exporter (blender_owners)
/// always gets its parent's name with the suffix BLENDER_ORIENTATION, by which find_blender_owner
/// recognizes it.
void GltfNodeWriter::write_name(
		const Entry &p_entry, const std::string &p_before, Json &r_node) const {
	if (p_entry.node->name != p_before) {
		r_node["name"] = p_entry.node->name;
	}
	if (p_entry.is_new) {
		return;
	}
	const auto owner = document->blender_owners.find(p_entry.index);
	if (owner != document->blender_owners.end()) {
		const std::string name =
				root["nodes"][owner->second]["name"].get<std::string>() + BLENDER_ORIENTATION;
		if (p_entry.node->name != p_before && p_entry.node->name != name) {
			log_warning("Light \"", p_entry.node->name, "\" is saved as \"", name,
					"\": its name follows its parent's. Rename the parent.");
		}
		r_node["name"] = name;
	}
}

/// Removes from the remaining nodes each mesh, light or camera that was deleted since loading.
void GltfNodeWriter::remove_deleted_attachments() {
	for (const size_t index : used_nodes) {
		Json &node = root["nodes"][index];
		if (document->node_surfaces.contains(index) && !mesh_nodes.contains(index)) {
			for (const char *key : { "mesh", "skin", "weights" }) {
				node.erase(key);
			}
		}
		if (document->cameras.contains(index) && !camera_nodes.contains(index)) {
			node.erase("camera");
		}
		if (document->lights.contains(index) && !light_nodes.contains(index)) {
			erase_member(node, "extensions", GLTF_PUNCTUAL);
			erase_member(node, "extensions", GLTF_AREA);
		}
	}
}

/// Removes from deleted nodes the children that have another parent now. Deleted nodes stay in the
/// file, unused, because indices must not change.
void GltfNodeWriter::detach_moved_children() {
	for (size_t index = 0; index < document->nodes.size(); ++index) {
		if (!used_nodes.contains(index) && document->nodes[index].is_loaded) {
			Json &node = root["nodes"][index];
			std::vector<size_t> children;
			if (node.contains("children") && !node["children"].is_null()) {
				node["children"].get_to(children);
			}
			std::erase_if(
					children, [this](size_t p_child) { return used_nodes.contains(p_child); });
			write_indices(node, "children", children);
		}
	}
}

void GltfNodeWriter::write_scene(const Scene &p_scene, const std::vector<size_t> &p_roots) {
	const double size_before_m = document ? document->scene_size_m : 0.0;
	const bool has_scene = !document || document->scene_index;
	const size_t scene_index = document ? document->scene_index.value_or(0) : 0;
	if (!has_scene) {
		// In a file without scenes all root nodes are shown. A scene is added only if that is no
		// longer enough: after nodes were added or deleted, or for a scene size.
		const bool is_same = p_scene.scene_size_m == size_before_m &&
				used_nodes.size() == document->nodes.size() &&
				(used_nodes.empty() || *used_nodes.rbegin() < document->nodes.size());
		if (is_same) {
			return;
		}
		root["scenes"] = Json::array({ Json::object() });
		root["scene"] = 0;
	}
	Json &scene = root["scenes"][scene_index];
	write_indices(scene, "nodes", p_roots);
	if (p_scene.scene_size_m != size_before_m) {
		if (p_scene.scene_size_m > 0 && std::isfinite(p_scene.scene_size_m)) {
			require_extras(scene)["scene_size"] = p_scene.scene_size_m;
		} else {
			erase_member(scene, "extras", "scene_size");
		}
	}
}

} // namespace gnomon
