#include "modules/gltf_scene/gltf_mesh_writer.h"

#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/gltf_scene/gltf_edit.h"
#include "modules/gltf_scene/gltf_materials.h"

#include <algorithm>

namespace gnomon {

namespace {

Json make_accessor(const char *p_type, int p_component_type, size_t p_count) {
	return { { "componentType", p_component_type }, { "count", p_count }, { "type", p_type } };
}

/// Returns whether a primitive states a material.
bool has_material(const Json &p_primitive) {
	const auto found = p_primitive.find("material");
	return found != p_primitive.end() && !found->is_null();
}

} // namespace

GltfMeshWriter::GltfMeshWriter(const GltfDocument *p_document, const Json &p_loaded, Json &r_root,
		size_t p_buffer_index, size_t p_first_byte, std::set<const Material *> p_used) :
		document(p_document),
		loaded(p_loaded), root(r_root), buffer_index(p_buffer_index), first_byte(p_first_byte),
		used(std::move(p_used)) {
	if (p_document == nullptr) {
		return;
	}
	material_indices = p_document->material_indices;
	for (const auto &[material, index] : material_indices) {
		original_materials.resize(std::max(original_materials.size(), index + 1));
		original_materials[index] = material;
	}
}

size_t GltfMeshWriter::append_mesh(
		const std::string &p_name, const std::vector<MeshInstance3D::Surface> &p_surfaces) {
	Json primitives = Json::array();
	for (const MeshInstance3D::Surface &surface : p_surfaces) {
		if (!surface.mesh || surface.mesh->indices.empty()) {
			continue;
		}
		auto found = accessors.find(surface.mesh.get());
		if (found == accessors.end()) {
			found = accessors.emplace(surface.mesh.get(), append_vertices(*surface.mesh)).first;
		}
		const Accessors &made = found->second;
		Json primitive = { { "attributes", made.attributes }, { "indices", made.indices },
			{ "mode", TINYGLTF_MODE_TRIANGLES } };
		if (surface.material) {
			primitive["material"] = store_material(*surface.material);
		}
		primitives.push_back(std::move(primitive));
	}
	return append_element(
			root, "meshes", { { "name", p_name }, { "primitives", std::move(primitives) } });
}

GltfMeshWriter::Accessors GltfMeshWriter::append_vertices(const Mesh &p_mesh) {
	if (p_mesh.attributes.rig) { // change_materials preserves the rigs of the document's meshes
		log_warning("Mesh \"", p_mesh.name, "\" is saved at rest, without its joints and morph ",
				"targets: they are preserved only in the file from which they were loaded.");
	}
	Accessors made;
	const auto append = [&](const char *p_name, const auto &p_values, const char *p_type) {
		if (!p_values.empty()) {
			made.attributes[p_name] = append_accessor(bytes_of(std::span(p_values)),
					make_accessor(p_type, TINYGLTF_COMPONENT_TYPE_FLOAT, p_values.size()),
					TINYGLTF_TARGET_ARRAY_BUFFER);
		}
	};
	const MeshAttributes &attributes = p_mesh.attributes;
	append("POSITION", p_mesh.positions_node, "VEC3");
	append("NORMAL", p_mesh.normals_node, "VEC3");
	append("TANGENT", attributes.tangents, "VEC4");
	append("TEXCOORD_0", attributes.uvs[0], "VEC2");
	append("TEXCOORD_1", attributes.uvs[1], "VEC2");
	append("COLOR_0", attributes.colors, "VEC4");
	// glTF requires bounds for positions. They are valid, because p_mesh has at least one triangle.
	const glm::dvec3 &low = p_mesh.bounds_node.minimum;
	const glm::dvec3 &high = p_mesh.bounds_node.maximum;
	Json &positions = root["accessors"][made.attributes["POSITION"].get<size_t>()];
	positions["min"] = { low.x, low.y, low.z };
	positions["max"] = { high.x, high.y, high.z };
	made.indices = append_accessor(bytes_of(std::span(p_mesh.indices)),
			make_accessor("SCALAR", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, p_mesh.indices.size()),
			TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
	return made;
}

size_t GltfMeshWriter::append_accessor(
		std::span<const uint8_t> p_data, Json p_accessor, int p_target) {
	// The element sizes are multiples of four bytes, so that every view is aligned as required.
	p_accessor["bufferView"] = append_element(root, "bufferViews",
			{ { "buffer", buffer_index }, { "byteOffset", first_byte + bytes.size() },
					{ "byteLength", p_data.size() }, { "target", p_target } });
	bytes.insert(bytes.end(), p_data.begin(), p_data.end());
	return append_element(root, "accessors", std::move(p_accessor));
}

size_t GltfMeshWriter::store_material(const Material &p_material) {
	if (const auto found = material_indices.find(&p_material); found != material_indices.end()) {
		return found->second;
	}
	const size_t original_index = static_cast<size_t>(p_material.file_index); // -1: SIZE_MAX
	const Material *before = original_index < original_materials.size()
			? original_materials[original_index]
			: nullptr;
	if (!before && std::ranges::any_of(p_material.list_textures(), [](const Texture *p_texture) {
			return p_texture->image != nullptr;
		})) {
		log_warning("Material \"", p_material.name, "\" is saved without its textures: they are ",
				"preserved only in the file from which they were loaded.");
	}
	Json made = before ? loaded["materials"][original_index] : Json::object();
	write_material(p_material, before, root, made);
	size_t index = original_index;
	if (before && !used.contains(before) && !document->shares_materials &&
			(!replaced.contains(original_index) || root["materials"][original_index] == made)) {
		replaced.insert(original_index);
		root["materials"][original_index] = std::move(made);
	} else {
		index = append_element(root, "materials", std::move(made));
	}
	material_indices[&p_material] = index;
	return index;
}

/// Finds the mesh of the document that has the same surfaces apart from their materials.
std::optional<size_t> GltfMeshWriter::find_loaded_mesh(
		const std::vector<MeshInstance3D::Surface> &p_surfaces) const {
	if (document == nullptr || p_surfaces.empty()) {
		return std::nullopt;
	}
	for (const auto &[key, index] : document->mesh_indices) {
		if (std::equal(key.begin(), key.end(), p_surfaces.begin(), p_surfaces.end(),
					[](const auto &p_key, const MeshInstance3D::Surface &p_surface) {
						return p_key.first == p_surface.mesh.get();
					})) {
			return index;
		}
	}
	return std::nullopt;
}

std::optional<size_t> GltfMeshWriter::change_materials(
		const std::vector<MeshInstance3D::Surface> &p_surfaces) {
	const std::optional<size_t> index = find_loaded_mesh(p_surfaces);
	if (!index) {
		return std::nullopt;
	}
	const Json &before = loaded["meshes"][*index];
	Json mesh = before;
	for (const MeshInstance3D::Surface &surface : p_surfaces) {
		Json &primitive = mesh["primitives"][document->primitive_indices.at(surface.mesh.get())];
		// A primitive without material was loaded with the default material, which has no file
		// index. As long as it still has this material, none is written.
		if (surface.material &&
				(surface.material->file_index >= 0 || has_material(primitive) ||
						!(*surface.material == Material()))) {
			primitive["material"] = store_material(*surface.material);
		}
	}
	if (mesh == before) {
		return index;
	}
	for (const size_t changed : changed_meshes) {
		if (root["meshes"][changed] == mesh) {
			return changed;
		}
	}
	changed_meshes.push_back(append_element(root, "meshes", std::move(mesh)));
	return changed_meshes.back();
}

} // namespace gnomon
