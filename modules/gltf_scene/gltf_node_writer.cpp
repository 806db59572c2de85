#include "modules/gltf_scene/gltf_node_writer.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_light_writer.h"
#include "modules/gltf_scene/gltf_transform_writer.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <typeinfo>

namespace gnomon {

namespace {

const char PUNCTUAL[] = "KHR_lights_punctual";
const char AREA[] = "EXT_lights_area";

std::optional<PropertyValue> find_size(const PropertyValues &p_properties) {
	const auto found = p_properties.find("light_size");
	return found == p_properties.end() ? std::nullopt : std::optional(found->second);
}

class NodeWriter {
public:
	NodeWriter(const GltfDocument *p_document, Json &r_json, GltfMeshWriter &r_meshes) :
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

void NodeWriter::write(const Scene &p_scene) {
	std::vector<size_t> roots;
	const Node3D &root = *p_scene.root;
	if (typeid(root) != typeid(Node3D) || root.parent_from_node != glm::dmat4(1.0)) {
		roots.push_back(*assign(root, nullptr)); // says something, so it becomes a node
	} else {
		for (const std::unique_ptr<Node3D> &child : root.children) {
			roots.push_back(*assign(*child, nullptr));
		}
	}
	for (const std::unique_ptr<Entry> &entry : entries) {
		write_entry(*entry);
	}
	if (document) {
		drop_lost_parts();
		drop_lost_children();
	}
	write_scene(p_scene, roots);
}

bool NodeWriter::is_part(const Node3D &p_node, const Entry *p_parent) const {
	if (!document || !p_parent || p_parent->is_new || p_node.file_index < 0 ||
			static_cast<size_t>(p_node.file_index) != p_parent->index || !p_node.children.empty() ||
			p_node.parent_from_node != glm::dmat4(1.0)) {
		return false; // moved away from its node or given children: it needs one of its own
	}
	return (dynamic_cast<const Light3D *>(&p_node) && document->lights.contains(p_parent->index)) ||
			(dynamic_cast<const Camera3D *>(&p_node) &&
					document->cameras.contains(p_parent->index));
}

/// Finds or makes the node's place in the file. Nothing for a part, which shares its parent's.
std::optional<size_t> NodeWriter::assign(const Node3D &p_node, const Entry *p_parent) {
	Entry &entry = *entries.emplace_back(std::make_unique<Entry>());
	entry.node = &p_node;
	entry.is_part = is_part(p_node, p_parent);
	if (entry.is_part) {
		entry.index = p_parent->index;
		return std::nullopt;
	}
	const size_t wanted = static_cast<size_t>(p_node.file_index);
	const bool has_place = document && p_node.file_index >= 0 && wanted < document->nodes.size() &&
			document->nodes[wanted].is_loaded && taken.insert(wanted).second;
	entry.is_new = !has_place;
	entry.index = wanted;
	if (entry.is_new) {
		json["nodes"].push_back(Json::object());
		entry.index = json["nodes"].size() - 1;
		taken.insert(entry.index);
	}
	for (const std::unique_ptr<Node3D> &child : p_node.children) {
		if (const std::optional<size_t> index = assign(*child, &entry)) {
			entry.children.push_back(*index);
		}
	}
	return entry.index;
}

void NodeWriter::write_entry(const Entry &p_entry) {
	const Node3D &node = *p_entry.node;
	Json &target = get_node(p_entry);
	if (!p_entry.is_part) {
		const GltfNodeState fresh;
		const GltfNodeState &before = p_entry.is_new ? fresh : document->nodes[p_entry.index];
		if (node.name != before.name) {
			target["name"] = node.name;
		}
		if (node.parent_from_node != before.parent_from_node) {
			write_transform(node, before.parent_from_node, target);
		}
		write_children(p_entry, target);
	}
	if (const auto *instance = dynamic_cast<const MeshInstance3D *>(&node)) {
		write_mesh(p_entry, *instance);
	} else if (const auto *light = dynamic_cast<const Light3D *>(&node)) {
		write_light_of(p_entry, *light);
	} else if (const auto *camera = dynamic_cast<const Camera3D *>(&node)) {
		write_camera(p_entry, *camera);
	}
}

void NodeWriter::write_children(const Entry &p_entry, Json &r_node) const {
	const auto before = r_node.find("children");
	const bool had_children = before != r_node.end() && !before->empty();
	if (p_entry.children.empty() && had_children) {
		r_node.erase("children");
	} else if (!p_entry.children.empty() && (!had_children || *before != Json(p_entry.children))) {
		r_node["children"] = p_entry.children;
	}
}

void NodeWriter::write_mesh(const Entry &p_entry, const MeshInstance3D &p_instance) {
	mesh_nodes.insert(p_entry.index);
	const auto key = GltfDocument::make_key(p_instance.surfaces);
	const bool had_mesh = !p_entry.is_new && document->node_surfaces.contains(p_entry.index);
	if (!had_mesh || document->node_surfaces.at(p_entry.index) != key) {
		const std::optional<size_t> mesh_index = find_or_append_mesh(p_instance, key);
		get_node(p_entry).erase("mesh");
		if (mesh_index) {
			get_node(p_entry)["mesh"] = *mesh_index;
		}
	}
	const GltfNodeState fresh;
	const GltfNodeState &before = p_entry.is_new ? fresh : document->nodes[p_entry.index];
	if (p_instance.casts_shadow != before.casts_shadow) {
		require_extras(get_node(p_entry))["casts_shadow"] = p_instance.casts_shadow;
	}
	if (p_instance.is_planar_receiver != before.is_planar_receiver) {
		require_extras(get_node(p_entry))["shadow_planar_receiver"] = p_instance.is_planar_receiver;
	}
}

std::optional<size_t> NodeWriter::find_or_append_mesh(
		const MeshInstance3D &p_instance, const GltfDocument::SurfaceKey &p_key) {
	if (const auto found = mesh_indices.find(p_key); found != mesh_indices.end()) {
		return found->second;
	}
	const auto &surfaces = p_instance.surfaces;
	const bool has_triangles =
			std::any_of(surfaces.begin(), surfaces.end(), [](const auto &p_surface) {
				return p_surface.mesh && !p_surface.mesh->indices.empty();
			});
	if (!has_triangles) {
		return std::nullopt;
	}
	const bool has_own_name = surfaces.size() == 1 && !surfaces[0].mesh->name.empty();
	const std::string &name = has_own_name ? surfaces[0].mesh->name : p_instance.name;
	return mesh_indices.emplace(p_key, meshes.append_mesh(name, surfaces)).first->second;
}

/// Puts a changed definition in the place of the old one, or behind the others where another node
/// has put a different one there. Returns its index.
size_t NodeWriter::place_definition(
		Json &r_list, Written &r_written, std::optional<size_t> p_index, Json p_definition) {
	if (p_index) {
		const auto [found, is_first] = r_written.try_emplace(*p_index, p_definition);
		if (is_first) {
			r_list[*p_index] = std::move(p_definition);
			return *p_index;
		}
		if (found->second == p_definition) {
			return *p_index;
		}
	}
	r_list.push_back(std::move(p_definition));
	return r_list.size() - 1;
}

/// The area light of a node, as its own copy: other nodes may share the definition.
Json *NodeWriter::own_area_light(Json &r_node) {
	const auto extensions = r_node.find("extensions");
	if (extensions == r_node.end() || !extensions->contains(AREA)) {
		return nullptr;
	}
	Json &list = json["extensions"][AREA]["lights"];
	Json &index = (*extensions)[AREA]["light"];
	Json copy = list[index.get<size_t>()];
	if (copy.value("type", "") != "disk") {
		return nullptr;
	}
	list.push_back(std::move(copy));
	index = list.size() - 1;
	return &list.back();
}

void NodeWriter::write_light_of(const Entry &p_entry, const Light3D &p_light) {
	light_nodes.insert(p_entry.index);
	const bool had_light = !p_entry.is_new && document->lights.contains(p_entry.index);
	const GltfLightState *before = had_light ? &document->lights.at(p_entry.index) : nullptr;
	Json definition = Json::object();
	std::optional<size_t> old_index;
	std::vector<Json *> places;
	Json *area = nullptr;
	if (before) {
		Json &target = get_node(p_entry);
		old_index = target["extensions"][PUNCTUAL]["light"].get<size_t>();
		definition = document->container.json["extensions"][PUNCTUAL]["lights"][*old_index];
		places.push_back(&target);
		if (const auto owner = document->blender_owners.find(p_entry.index);
				owner != document->blender_owners.end()) {
			places.push_back(&json["nodes"][owner->second]);
		}
		if (find_size(before->properties) != find_size(p_light.properties)) {
			area = own_area_light(target);
		}
	} else {
		definition["name"] = p_light.name;
		declare_extension(json, PUNCTUAL);
	}
	write_light(p_light, before, definition, places, area);
	const size_t index = place_definition(
			json["extensions"][PUNCTUAL]["lights"], lights, old_index, std::move(definition));
	if (index != old_index) {
		get_node(p_entry)["extensions"][PUNCTUAL]["light"] = index;
	}
}

void NodeWriter::write_camera(const Entry &p_entry, const Camera3D &p_camera) {
	camera_nodes.insert(p_entry.index);
	const bool had_camera = !p_entry.is_new && document->cameras.contains(p_entry.index);
	const std::pair<float, float> values = { p_camera.vertical_fov_rad, p_camera.near_m };
	Json definition = { { "type", "perspective" }, { "perspective", Json::object() } };
	std::optional<size_t> old_index;
	if (had_camera) {
		old_index = get_node(p_entry)["camera"].get<size_t>();
		definition = document->container.json["cameras"][*old_index];
	}
	if (!had_camera || document->cameras.at(p_entry.index).first != values.first) {
		definition["perspective"]["yfov"] = to_json_number(values.first);
	}
	if (!had_camera || document->cameras.at(p_entry.index).second != values.second) {
		definition["perspective"]["znear"] = to_json_number(values.second);
	}
	const size_t index =
			place_definition(json["cameras"], cameras, old_index, std::move(definition));
	if (index != old_index) {
		get_node(p_entry)["camera"] = index;
	}
}

/// A mesh, light or camera that was loaded with a node and is gone, while the node is not.
void NodeWriter::drop_lost_parts() {
	for (const size_t index : taken) {
		Json &node = json["nodes"][index];
		if (document->node_surfaces.contains(index) && !mesh_nodes.contains(index)) {
			node.erase("mesh");
		}
		if (document->cameras.contains(index) && !camera_nodes.contains(index)) {
			node.erase("camera");
		}
		if (document->lights.contains(index) && !light_nodes.contains(index)) {
			node["extensions"].erase(PUNCTUAL);
			node["extensions"].erase(AREA);
		}
	}
}

/// Nodes that were removed stay in the file, unused, as indices must not change; but they may not
/// keep children that live on elsewhere.
void NodeWriter::drop_lost_children() {
	for (size_t index = 0; index < document->nodes.size(); ++index) {
		Json &node = json["nodes"][index];
		if (taken.contains(index) || !document->nodes[index].is_loaded ||
				!node.contains("children")) {
			continue;
		}
		Json kept = Json::array();
		for (const Json &child : node["children"]) {
			if (!taken.contains(child.get<size_t>())) {
				kept.push_back(child);
			}
		}
		node["children"] = kept;
		if (kept.empty()) {
			node.erase("children");
		}
	}
}

void NodeWriter::write_scene(const Scene &p_scene, const std::vector<size_t> &p_roots) {
	const double size_before_m = document ? document->scene_size_m : 0.0;
	const bool has_scene = !document || document->scene_index;
	const size_t scene_index = document ? document->scene_index.value_or(0) : 0;
	Json all_roots = Json(p_roots);
	if (!has_scene) {
		// Without scenes every node without a parent is shown: as long as that is so, none is made.
		const bool is_same = p_scene.scene_size_m == size_before_m &&
				taken.size() == document->nodes.size() && json["nodes"].size() == taken.size();
		if (is_same) {
			return;
		}
		json["scenes"] = Json::array({ Json::object() });
		json["scene"] = 0;
	}
	Json &scene = json["scenes"][scene_index];
	const auto before = scene.find("nodes");
	const bool had_roots = before != scene.end() && !before->empty();
	if (p_roots.empty() && had_roots) {
		scene.erase("nodes"); // an empty list is not allowed
	} else if (!p_roots.empty() && (!had_roots || *before != all_roots)) {
		scene["nodes"] = std::move(all_roots);
	}
	if (p_scene.scene_size_m != size_before_m) {
		Json &extras = require_extras(scene);
		extras.erase("scene_size");
		if (p_scene.scene_size_m > 0 && std::isfinite(p_scene.scene_size_m)) {
			extras["scene_size"] = p_scene.scene_size_m;
		}
	}
}

} // namespace

void write_nodes(const Scene &p_scene, const GltfDocument *p_document, Json &r_json,
		GltfMeshWriter &r_meshes) {
	NodeWriter(p_document, r_json, r_meshes).write(p_scene);
}

} // namespace gnomon
