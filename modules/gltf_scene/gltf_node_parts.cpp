// The part of GltfNodeWriter that writes what is attached to a node: its mesh, light and camera.
#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_edit.h"
#include "modules/gltf_scene/gltf_lights.h"
#include "modules/gltf_scene/gltf_node_writer.h"

#include <algorithm>

namespace gnomon {

namespace {

std::optional<PropertyValue> find_light_size(const PropertyValues &p_properties) {
	const auto found = p_properties.find("light_size");
	return found == p_properties.end() ? std::nullopt : std::optional(found->second);
}

} // namespace

void GltfNodeWriter::write_mesh(const Entry &p_entry, const MeshInstance3D &p_instance) {
	mesh_nodes.insert(p_entry.index);
	const auto key = GltfDocument::make_key(p_instance.surfaces);
	const bool had_mesh = !p_entry.is_new && document->node_surfaces.contains(p_entry.index);
	if (!had_mesh || document->node_surfaces.at(p_entry.index) != key) {
		const std::optional<size_t> mesh_index = find_or_append_mesh(p_instance, key);
		if (mesh_index) {
			get_node(p_entry)["mesh"] = *mesh_index;
		} else {
			get_node(p_entry).erase("mesh");
		}
		if (!had_mesh && mesh_index) {
			write_motion(root["meshes"][*mesh_index], p_instance, get_node(p_entry));
		}
	}
	const GltfNodeState defaults;
	const GltfNodeState &before = p_entry.is_new ? defaults : document->nodes[p_entry.index];
	if (p_instance.casts_shadow != before.casts_shadow) {
		require_extras(get_node(p_entry))["casts_shadow"] = p_instance.casts_shadow;
	}
	if (p_instance.is_planar_receiver != before.is_planar_receiver) {
		require_extras(get_node(p_entry))["shadow_planar_receiver"] = p_instance.is_planar_receiver;
	}
}

/// Writes the skin and the morph weights of a node that had no mesh in the file. p_mesh: the mesh
/// that was written for it. Only meshes from the document have joints and morph targets.
void GltfNodeWriter::write_motion(
		const Json &p_mesh, const MeshInstance3D &p_instance, Json &r_node) const {
	bool has_joints = false;
	bool has_targets = false;
	for (const Json &primitive : p_mesh["primitives"]) {
		has_joints |= primitive["attributes"].contains("JOINTS_0");
		has_targets |= primitive.contains("targets");
	}
	if (document && has_joints) {
		const auto skin = document->skin_indices.find(p_instance.skin.get());
		if (skin != document->skin_indices.end()) {
			r_node["skin"] = skin->second;
		}
	}
	const std::vector<float> &weights = p_instance.morph_weights;
	const Json defaults = p_mesh.value("weights", Json::array());
	bool has_defaults = true;
	for (size_t index = 0; index < weights.size(); ++index) {
		const bool is_given =
				defaults.is_array() && index < defaults.size() && defaults[index].is_number();
		has_defaults &= weights[index] == (is_given ? defaults[index].get<float>() : 0.0f);
	}
	if (has_targets && !has_defaults) {
		write_floats(r_node, "weights", weights);
	}
}

std::optional<size_t> GltfNodeWriter::find_or_append_mesh(
		const MeshInstance3D &p_instance, const GltfDocument::SurfaceKey &p_key) {
	if (const auto found = mesh_indices.find(p_key); found != mesh_indices.end()) {
		return found->second;
	}
	const auto &surfaces = p_instance.surfaces;
	if (const std::optional<size_t> changed = meshes.change_materials(surfaces)) {
		return mesh_indices.emplace(p_key, *changed).first->second;
	}
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

/// Replaces the definition at p_index by p_definition. Appends it instead if there is no index or
/// if a different definition was written there for another node. Returns its index.
size_t GltfNodeWriter::store_definition(Json &r_parent, const char *p_list,
		DefinitionMap &r_written, std::optional<size_t> p_index, Json p_definition) {
	if (p_index) {
		const auto [found, is_first] = r_written.try_emplace(*p_index, p_definition);
		if (is_first) {
			r_parent[p_list][*p_index] = std::move(p_definition);
			return *p_index;
		}
		if (found->second == p_definition) {
			return *p_index;
		}
	}
	return append_element(r_parent, p_list, std::move(p_definition));
}

/// Gives the node a copy of its area light, because other nodes may share the definition, and
/// returns the copy. Returns null if the node has no area light of type "disk".
Json *GltfNodeWriter::copy_area_light(Json &r_node) {
	Json &extensions = r_node["extensions"];
	const auto reference = extensions.find(GLTF_AREA);
	if (reference == extensions.end() || reference->is_null()) {
		return nullptr;
	}
	Json &area = root["extensions"][GLTF_AREA];
	Json copy = area["lights"][(*reference)["light"].get<size_t>()];
	if (copy["type"] != "disk") {
		return nullptr;
	}
	const size_t index = append_element(area, "lights", std::move(copy));
	(*reference)["light"] = index;
	return &area["lights"][index];
}

void GltfNodeWriter::write_node_light(const Entry &p_entry, const Light3D &p_light) {
	light_nodes.insert(p_entry.index);
	const bool had_light = !p_entry.is_new && document->lights.contains(p_entry.index);
	const LightSettings *before = had_light ? &document->lights.at(p_entry.index) : nullptr;
	if (!before) { // first, because it invalidates references into the document
		require_extension(root, root, GLTF_PUNCTUAL);
	}
	Json &target = get_node(p_entry);
	Json definition = Json::object();
	std::optional<size_t> old_index;
	std::vector<Json *> owners; // nodes whose extras may hold the light's properties
	Json *area = nullptr;
	if (before) {
		old_index = target["extensions"][GLTF_PUNCTUAL]["light"].get<size_t>();
		definition = loaded["extensions"][GLTF_PUNCTUAL]["lights"][*old_index];
		owners.push_back(&target);
		if (const auto owner = document->blender_owners.find(p_entry.index);
				owner != document->blender_owners.end()) {
			owners.push_back(&root["nodes"][owner->second]);
		}
		if (find_light_size(before->properties) != find_light_size(p_light.properties)) {
			area = copy_area_light(target);
		}
	} else {
		definition["name"] = p_light.name;
	}
	write_light(p_light, before, definition, owners, area);
	const size_t index = store_definition(
			root["extensions"][GLTF_PUNCTUAL], "lights", lights, old_index, std::move(definition));
	if (index != old_index) {
		require_object(require_object(target, "extensions"), GLTF_PUNCTUAL)["light"] = index;
	}
}

void GltfNodeWriter::write_camera(const Entry &p_entry, const Camera3D &p_camera) {
	camera_nodes.insert(p_entry.index);
	const bool had_camera = !p_entry.is_new && document->cameras.contains(p_entry.index);
	Json definition = { { "type", "perspective" }, { "perspective", Json::object() } };
	std::optional<size_t> old_index;
	if (had_camera) {
		old_index = get_node(p_entry)["camera"].get<size_t>();
		definition = loaded["cameras"][*old_index];
	}
	Json &perspective = definition["perspective"];
	if (!had_camera ||
			document->cameras.at(p_entry.index).vertical_fov_rad != p_camera.vertical_fov_rad) {
		write_float(perspective, "yfov", p_camera.vertical_fov_rad);
	}
	if (!had_camera || document->cameras.at(p_entry.index).near_m != p_camera.near_m) {
		write_float(perspective, "znear", p_camera.near_m);
	}
	const size_t index =
			store_definition(root, "cameras", cameras, old_index, std::move(definition));
	if (index != old_index) {
		get_node(p_entry)["camera"] = index;
	}
}

} // namespace gnomon
