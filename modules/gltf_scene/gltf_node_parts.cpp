// The part of GltfNodeWriter that writes what is attached to a node: its mesh, light and camera.
#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_lights.h"
#include "modules/gltf_scene/gltf_node_writer.h"
#include "modules/gltf_scene/gltf_values.h"

#include <algorithm>

namespace gnomon {

namespace {

std::optional<PropertyValue> find_light_size(const PropertyValues &p_properties) {
	const auto found = p_properties.find("light_size");
	return found == p_properties.end() ? std::nullopt : std::optional(found->second);
}

/// Compares all members, because tinygltf's operator== compares only some, such as name and colour.
bool is_same(const tinygltf::Light &p_first, const tinygltf::Light &p_second) {
	return p_first == p_second && p_first.intensity == p_second.intensity &&
			p_first.range == p_second.range &&
			p_first.spot.innerConeAngle == p_second.spot.innerConeAngle &&
			p_first.spot.outerConeAngle == p_second.spot.outerConeAngle &&
			p_first.extensions == p_second.extensions && p_first.extras == p_second.extras;
}

bool is_same(const tinygltf::Camera &p_first, const tinygltf::Camera &p_second) {
	return p_first == p_second;
}

} // namespace

void GltfNodeWriter::write_mesh(const Entry &p_entry, const MeshInstance3D &p_instance) {
	mesh_nodes.insert(p_entry.index);
	const auto key = GltfDocument::make_key(p_instance.surfaces);
	const bool had_mesh = !p_entry.is_new && document->node_surfaces.contains(p_entry.index);
	if (!had_mesh || document->node_surfaces.at(p_entry.index) != key) {
		const std::optional<size_t> mesh_index = find_or_append_mesh(p_instance, key);
		get_node(p_entry).mesh = mesh_index ? static_cast<int>(*mesh_index) : -1;
		if (!had_mesh && mesh_index) {
			write_motion(model.meshes[*mesh_index], p_instance, get_node(p_entry));
		}
	}
	const GltfNodeState defaults;
	const GltfNodeState &before = p_entry.is_new ? defaults : document->nodes[p_entry.index];
	if (p_instance.casts_shadow != before.casts_shadow) {
		require_extras(get_node(p_entry).extras)["casts_shadow"] =
				tinygltf::Value(p_instance.casts_shadow);
	}
	if (p_instance.is_planar_receiver != before.is_planar_receiver) {
		require_extras(get_node(p_entry).extras)["shadow_planar_receiver"] =
				tinygltf::Value(p_instance.is_planar_receiver);
	}
}

/// Writes the skin and the morph weights of a node that had no mesh in the file. p_mesh: the mesh
/// that was written for it. Only meshes from the document have joints and morph targets.
void GltfNodeWriter::write_motion(const tinygltf::Mesh &p_mesh, const MeshInstance3D &p_instance,
		tinygltf::Node &r_node) const {
	bool has_joints = false;
	bool has_targets = false;
	for (const tinygltf::Primitive &primitive : p_mesh.primitives) {
		has_joints |= primitive.attributes.contains("JOINTS_0");
		has_targets |= !primitive.targets.empty();
	}
	if (document && has_joints) {
		const auto skin = document->skin_indices.find(p_instance.skin.get());
		r_node.skin = skin == document->skin_indices.end() ? -1 : static_cast<int>(skin->second);
	}
	std::vector<double> weights;
	for (const float weight : p_instance.morph_weights) {
		weights.push_back(to_shortest_decimal(weight));
	}
	std::vector<double> mesh_weights = p_mesh.weights;
	mesh_weights.resize(weights.size(), 0.0);
	if (has_targets && weights != mesh_weights) {
		r_node.weights = std::move(weights);
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
template <typename T>
size_t GltfNodeWriter::store_definition(std::vector<T> &r_list, DefinitionMap<T> &r_written,
		std::optional<size_t> p_index, T p_definition) {
	if (p_index) {
		const auto [found, is_first] = r_written.try_emplace(*p_index, p_definition);
		if (is_first) {
			r_list[*p_index] = std::move(p_definition);
			return *p_index;
		}
		if (is_same(found->second, p_definition)) {
			return *p_index;
		}
	}
	r_list.push_back(std::move(p_definition));
	return r_list.size() - 1;
}

/// Gives the node a copy of its area light, because other nodes may share the definition, and
/// returns the copy. Returns null if the node has no area light of type "disk".
tinygltf::Value *GltfNodeWriter::copy_area_light(tinygltf::Node &r_node) {
	using tinygltf::Value;
	const auto reference = r_node.extensions.find(GLTF_AREA);
	if (reference == r_node.extensions.end()) {
		return nullptr;
	}
	auto &area_lights =
			require_object(model.extensions.at(GLTF_AREA))["lights"].Get<Value::Array>();
	Value copy = area_lights[static_cast<size_t>(reference->second.Get("light").GetNumberAsInt())];
	if (!copy.Has("type") || !copy.Get("type").IsString() ||
			copy.Get("type").Get<std::string>() != "disk") {
		return nullptr;
	}
	require_object(reference->second)["light"] = Value(static_cast<int>(area_lights.size()));
	return &area_lights.emplace_back(std::move(copy));
}

void GltfNodeWriter::write_node_light(const Entry &p_entry, const Light3D &p_light) {
	light_nodes.insert(p_entry.index);
	const bool had_light = !p_entry.is_new && document->lights.contains(p_entry.index);
	const LightSettings *before = had_light ? &document->lights.at(p_entry.index) : nullptr;
	tinygltf::Node &target = get_node(p_entry);
	tinygltf::Light definition;
	std::optional<size_t> old_index;
	std::vector<tinygltf::Node *> owners; // nodes whose extras may hold the light's properties
	tinygltf::Value *area = nullptr;
	if (before) {
		old_index = static_cast<size_t>(
				target.extensions.at(GLTF_PUNCTUAL).Get("light").GetNumberAsInt());
		definition = document->model.lights[*old_index];
		owners.push_back(&target);
		if (const auto owner = document->blender_owners.find(p_entry.index);
				owner != document->blender_owners.end()) {
			owners.push_back(&model.nodes[owner->second]);
		}
		if (find_light_size(before->properties) != find_light_size(p_light.properties)) {
			area = copy_area_light(target);
		}
	} else {
		definition.name = p_light.name;
		declare_extension(model, GLTF_PUNCTUAL);
	}
	write_light(p_light, before, definition, owners, area);
	const size_t index = store_definition(model.lights, lights, old_index, std::move(definition));
	if (index != old_index) {
		require_object(target.extensions[GLTF_PUNCTUAL])["light"] =
				tinygltf::Value(static_cast<int>(index));
	}
}

void GltfNodeWriter::write_camera(const Entry &p_entry, const Camera3D &p_camera) {
	camera_nodes.insert(p_entry.index);
	const bool had_camera = !p_entry.is_new && document->cameras.contains(p_entry.index);
	tinygltf::Camera definition;
	definition.type = "perspective";
	std::optional<size_t> old_index;
	if (had_camera) {
		old_index = static_cast<size_t>(get_node(p_entry).camera);
		definition = document->model.cameras[*old_index];
	}
	// document->cameras: pairs of field of view and near plane.
	if (!had_camera || document->cameras.at(p_entry.index).first != p_camera.vertical_fov_rad) {
		definition.perspective.yfov = to_shortest_decimal(p_camera.vertical_fov_rad);
	}
	if (!had_camera || document->cameras.at(p_entry.index).second != p_camera.near_m) {
		definition.perspective.znear = to_shortest_decimal(p_camera.near_m);
	}
	const size_t index = store_definition(model.cameras, cameras, old_index, std::move(definition));
	get_node(p_entry).camera = static_cast<int>(index);
}

} // namespace gnomon
