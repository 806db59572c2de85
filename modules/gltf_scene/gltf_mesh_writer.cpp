#include "modules/gltf_scene/gltf_mesh_writer.h"

#include "modules/core/files.h"
#include "modules/gltf_scene/gltf_materials.h"

#include <tiny_gltf.h>

#include <algorithm>

namespace gnomon {

namespace {

size_t append_element(Json &r_json, const char *p_list, Json p_element) {
	Json &list = r_json[p_list];
	list.push_back(std::move(p_element));
	return list.size() - 1;
}

} // namespace

GltfMeshWriter::GltfMeshWriter(Json &r_json, size_t p_buffer_index, size_t p_first_byte,
		const GltfDocument *p_document, std::set<const Material *> p_used) :
		json(r_json),
		document(p_document), buffer_index(p_buffer_index), first_byte(p_first_byte),
		used(std::move(p_used)) {
	if (p_document == nullptr) {
		return;
	}
	material_indices = p_document->material_indices;
	for (const auto &[material, index] : material_indices) {
		loaded_materials.resize(std::max(loaded_materials.size(), index + 1));
		loaded_materials[index] = material;
	}
}

size_t GltfMeshWriter::append_mesh(
		const std::string &p_name, const std::vector<MeshInstance3D::Surface> &p_surfaces) {
	Json mesh = { { "name", p_name }, { "primitives", Json::array() } };
	for (const MeshInstance3D::Surface &surface : p_surfaces) {
		if (!surface.mesh || surface.mesh->indices.empty()) {
			continue;
		}
		auto found = accessors.find(surface.mesh.get());
		if (found == accessors.end()) {
			found = accessors.emplace(surface.mesh.get(), append_vertices(*surface.mesh)).first;
		}
		const Accessors &made = found->second;
		Json primitive = { { "attributes",
								   { { "POSITION", made.positions }, { "NORMAL", made.normals } } },
			{ "indices", made.indices } };
		if (surface.material) {
			primitive["material"] = place_material(*surface.material);
		}
		mesh["primitives"].push_back(std::move(primitive));
	}
	return append_element(json, "meshes", std::move(mesh));
}

GltfMeshWriter::Accessors GltfMeshWriter::append_vertices(const Mesh &p_mesh) {
	const Json vectors = { { "componentType", TINYGLTF_COMPONENT_TYPE_FLOAT }, { "type", "VEC3" } };
	Json positions = vectors;
	// The specification wants them for positions; p_mesh has at least one triangle.
	positions["min"] = to_json(glm::vec3(p_mesh.bounds_node.minimum));
	positions["max"] = to_json(glm::vec3(p_mesh.bounds_node.maximum));
	Accessors made;
	made.positions = append_accessor(bytes_of(std::span(p_mesh.positions_node)),
			p_mesh.positions_node.size(), std::move(positions), TINYGLTF_TARGET_ARRAY_BUFFER);
	made.normals = append_accessor(bytes_of(std::span(p_mesh.normals_node)),
			p_mesh.normals_node.size(), vectors, TINYGLTF_TARGET_ARRAY_BUFFER);
	made.indices = append_accessor(bytes_of(std::span(p_mesh.indices)), p_mesh.indices.size(),
			{ { "componentType", TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT }, { "type", "SCALAR" } },
			TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
	return made;
}

size_t GltfMeshWriter::append_accessor(
		std::span<const uint8_t> p_data, size_t p_count, Json p_accessor, int p_target) {
	// Elements are multiples of four bytes, so that every view stays aligned as it must.
	const size_t view = append_element(json, "bufferViews",
			{ { "buffer", buffer_index }, { "byteOffset", first_byte + bytes.size() },
					{ "byteLength", p_data.size() }, { "target", p_target } });
	bytes.insert(bytes.end(), p_data.begin(), p_data.end());
	p_accessor["bufferView"] = view;
	p_accessor["count"] = p_count;
	return append_element(json, "accessors", std::move(p_accessor));
}

size_t GltfMeshWriter::place_material(const Material &p_material) {
	if (const auto found = material_indices.find(&p_material); found != material_indices.end()) {
		return found->second;
	}
	const size_t origin = static_cast<size_t>(p_material.file_index); // -1: beyond all
	const Material *before = origin < loaded_materials.size() ? loaded_materials[origin] : nullptr;
	Json made = before ? json["materials"][origin] : Json::object();
	if (before && replaced.contains(origin)) {
		made = replaced.at(origin); // as it was loaded
	}
	const Json loaded = made;
	write_material(p_material, before, json, made);
	size_t index = origin;
	if (before && !used.contains(before) && !document->shares_materials &&
			(!replaced.contains(origin) || json["materials"][origin] == made)) {
		replaced.try_emplace(origin, loaded);
		json["materials"][origin] = std::move(made);
	} else {
		index = append_element(json, "materials", std::move(made));
	}
	material_indices[&p_material] = index;
	return index;
}

/// The document's mesh of these surfaces, whatever their materials.
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
	Json mesh = document->container.json["meshes"][*index];
	for (const MeshInstance3D::Surface &surface : p_surfaces) {
		Json &primitive = mesh["primitives"][document->primitive_indices.at(surface.mesh.get())];
		// The reader's default material has no index: a primitive without one keeps it.
		if (surface.material &&
				(surface.material->file_index >= 0 || primitive.contains("material") ||
						!(*surface.material == Material()))) {
			primitive["material"] = place_material(*surface.material);
		}
	}
	if (mesh == document->container.json["meshes"][*index]) {
		return index;
	}
	const auto found = changed_meshes.find(mesh);
	if (found != changed_meshes.end()) {
		return found->second;
	}
	return changed_meshes[mesh] = append_element(json, "meshes", mesh);
}

} // namespace gnomon
