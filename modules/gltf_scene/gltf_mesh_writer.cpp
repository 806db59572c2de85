#include "modules/gltf_scene/gltf_mesh_writer.h"

#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/gltf_scene/gltf_materials.h"

#include <algorithm>

namespace gnomon {

namespace {

/// Appends an element and returns its index.
template <typename T> int append_element(std::vector<T> &r_list, T p_element) {
	r_list.push_back(std::move(p_element));
	return static_cast<int>(r_list.size() - 1);
}

tinygltf::Accessor make_accessor(int p_type, int p_component_type, size_t p_count) {
	tinygltf::Accessor accessor;
	accessor.type = p_type;
	accessor.componentType = p_component_type;
	accessor.count = p_count;
	return accessor;
}

} // namespace

GltfMeshWriter::GltfMeshWriter(tinygltf::Model &r_model, size_t p_buffer_index, size_t p_first_byte,
		const GltfDocument *p_document, std::set<const Material *> p_used) :
		model(r_model),
		document(p_document), buffer_index(p_buffer_index), first_byte(p_first_byte),
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
	tinygltf::Mesh mesh;
	mesh.name = p_name;
	for (const MeshInstance3D::Surface &surface : p_surfaces) {
		if (!surface.mesh || surface.mesh->indices.empty()) {
			continue;
		}
		auto found = accessors.find(surface.mesh.get());
		if (found == accessors.end()) {
			found = accessors.emplace(surface.mesh.get(), append_vertices(*surface.mesh)).first;
		}
		const Accessors &made = found->second;
		tinygltf::Primitive primitive;
		primitive.mode = TINYGLTF_MODE_TRIANGLES;
		primitive.attributes = made.attributes;
		primitive.indices = made.indices;
		if (surface.material) {
			primitive.material = static_cast<int>(store_material(*surface.material));
		}
		mesh.primitives.push_back(std::move(primitive));
	}
	return static_cast<size_t>(append_element(model.meshes, std::move(mesh)));
}

GltfMeshWriter::Accessors GltfMeshWriter::append_vertices(const Mesh &p_mesh) {
	if (p_mesh.attributes.rig) { // change_materials preserves the rigs of the document's meshes
		log_warning("Mesh \"", p_mesh.name, "\" is saved at rest, without its joints and morph ",
				"targets: they are preserved only in the file from which they were loaded.");
	}
	Accessors made;
	const auto append = [&](const char *p_name, const auto &p_values, int p_type) {
		if (!p_values.empty()) {
			made.attributes[p_name] = append_accessor(bytes_of(std::span(p_values)),
					make_accessor(p_type, TINYGLTF_COMPONENT_TYPE_FLOAT, p_values.size()),
					TINYGLTF_TARGET_ARRAY_BUFFER);
		}
	};
	const MeshAttributes &attributes = p_mesh.attributes;
	append("POSITION", p_mesh.positions_node, TINYGLTF_TYPE_VEC3);
	append("NORMAL", p_mesh.normals_node, TINYGLTF_TYPE_VEC3);
	append("TANGENT", attributes.tangents, TINYGLTF_TYPE_VEC4);
	append("TEXCOORD_0", attributes.uvs[0], TINYGLTF_TYPE_VEC2);
	append("TEXCOORD_1", attributes.uvs[1], TINYGLTF_TYPE_VEC2);
	append("COLOR_0", attributes.colors, TINYGLTF_TYPE_VEC4);
	// glTF requires bounds for positions. They are valid, because p_mesh has at least one triangle.
	const glm::dvec3 &low = p_mesh.bounds_node.minimum;
	const glm::dvec3 &high = p_mesh.bounds_node.maximum;
	tinygltf::Accessor &positions = model.accessors[made.attributes.at("POSITION")];
	positions.minValues = { low.x, low.y, low.z };
	positions.maxValues = { high.x, high.y, high.z };
	made.indices = append_accessor(bytes_of(std::span(p_mesh.indices)),
			make_accessor(TINYGLTF_TYPE_SCALAR, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
					p_mesh.indices.size()),
			TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
	return made;
}

int GltfMeshWriter::append_accessor(
		std::span<const uint8_t> p_data, tinygltf::Accessor p_accessor, int p_target) {
	// The element sizes are multiples of four bytes, so that every view is aligned as required.
	tinygltf::BufferView view;
	view.buffer = static_cast<int>(buffer_index);
	view.byteOffset = first_byte + bytes.size();
	view.byteLength = p_data.size();
	view.target = p_target;
	bytes.insert(bytes.end(), p_data.begin(), p_data.end());
	p_accessor.bufferView = append_element(model.bufferViews, std::move(view));
	return append_element(model.accessors, std::move(p_accessor));
}

size_t GltfMeshWriter::store_material(const Material &p_material) {
	if (const auto found = material_indices.find(&p_material); found != material_indices.end()) {
		return found->second;
	}
	const size_t original_index = static_cast<size_t>(p_material.file_index); // -1: SIZE_MAX
	const Material *before = original_index < original_materials.size()
			? original_materials[original_index]
			: nullptr;
	const tinygltf::Material loaded = !before	? tinygltf::Material()
			: replaced.contains(original_index) ? replaced.at(original_index)
												: model.materials[original_index];
	if (!before && std::ranges::any_of(p_material.list_textures(), [](const Texture *p_texture) {
			return p_texture->image != nullptr;
		})) {
		log_warning("Material \"", p_material.name, "\" is saved without its textures: they are ",
				"preserved only in the file from which they were loaded.");
	}
	tinygltf::Material made = loaded;
	write_material(p_material, before, model, made);
	size_t index = original_index;
	if (before && !used.contains(before) && !document->shares_materials &&
			(!replaced.contains(original_index) || model.materials[original_index] == made)) {
		replaced.try_emplace(original_index, loaded);
		model.materials[original_index] = std::move(made);
	} else {
		index = static_cast<size_t>(append_element(model.materials, std::move(made)));
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
	const tinygltf::Mesh &loaded = document->model.meshes[*index];
	tinygltf::Mesh mesh = loaded;
	for (const MeshInstance3D::Surface &surface : p_surfaces) {
		tinygltf::Primitive &primitive =
				mesh.primitives[document->primitive_indices.at(surface.mesh.get())];
		// A primitive without material was loaded with the default material, which has no file
		// index. As long as it still has this material, none is written.
		if (surface.material &&
				(surface.material->file_index >= 0 || primitive.material >= 0 ||
						!(*surface.material == Material()))) {
			primitive.material = static_cast<int>(store_material(*surface.material));
		}
	}
	if (mesh == loaded) {
		return index;
	}
	for (const size_t changed : changed_meshes) {
		if (model.meshes[changed] == mesh) {
			return changed;
		}
	}
	changed_meshes.push_back(static_cast<size_t>(append_element(model.meshes, std::move(mesh))));
	return changed_meshes.back();
}

} // namespace gnomon
