#include "modules/gltf_scene/gltf_mesh_writer.h"

#include "modules/core/files.h"
#include "modules/gltf_scene/gltf_light_writer.h"

#include <tiny_gltf.h>

#include <algorithm>

namespace gnomon {

namespace {

Json to_json(const glm::vec3 &p_vector) {
	return Json::array(
			{ to_json_number(p_vector.x), to_json_number(p_vector.y), to_json_number(p_vector.z) });
}

size_t append_element(Json &r_json, const char *p_list, Json p_element) {
	Json &list = r_json[p_list];
	list.push_back(std::move(p_element));
	return list.size() - 1;
}

} // namespace

GltfMeshWriter::GltfMeshWriter(Json &r_json, size_t p_buffer_index, size_t p_first_byte,
		std::map<const Material *, size_t> p_material_indices) :
		json(r_json),
		buffer_index(p_buffer_index), first_byte(p_first_byte),
		material_indices(std::move(p_material_indices)) {}

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
			primitive["material"] = append_material(*surface.material);
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

size_t GltfMeshWriter::append_material(const Material &p_material) {
	if (const auto found = material_indices.find(&p_material); found != material_indices.end()) {
		return found->second;
	}
	Json made = Json::object();
	if (!p_material.name.empty()) {
		made["name"] = p_material.name;
	}
	Json color = to_json(p_material.base_color);
	color.push_back(1.0);
	made["pbrMetallicRoughness"] = { { "baseColorFactor", std::move(color) },
		{ "metallicFactor", to_json_number(p_material.metallic) },
		{ "roughnessFactor", to_json_number(p_material.roughness) } };
	const glm::vec3 &emissive = p_material.emissive;
	const float strength = std::max({ 1.0f, emissive.x, emissive.y, emissive.z });
	if (emissive != glm::vec3(0.0f)) {
		made["emissiveFactor"] = to_json(emissive / strength);
	}
	if (strength > 1.0f) { // the factor alone ends at 1
		made["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] =
				to_json_number(strength);
		declare_extension(json, "KHR_materials_emissive_strength");
	}
	if (p_material.is_double_sided) {
		made["doubleSided"] = true;
	}
	if (p_material.scatter != 0 || p_material.scatter_distance_m != 0) {
		made["extras"] = { { "scatter", to_json_number(p_material.scatter) },
			{ "scatter_distance", to_json_number(p_material.scatter_distance_m) } };
	}
	const size_t index = append_element(json, "materials", std::move(made));
	material_indices[&p_material] = index;
	return index;
}

void declare_extension(Json &r_json, const std::string &p_name) {
	Json &used = r_json["extensionsUsed"];
	if (std::find(used.begin(), used.end(), p_name) == used.end()) {
		used.push_back(p_name);
	}
}

} // namespace gnomon
