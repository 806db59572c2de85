#include "modules/gltf_scene/gltf_meshes.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_rigs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gnomon {

namespace {

/// Returns three indices per triangle, with the winding of glTF 2.0, 3.7.2.1. Skips an incomplete
/// last triangle, and the degenerate triangles of strips and fans.
std::vector<uint32_t> make_triangles(std::vector<uint32_t> p_indices, int p_mode) {
	if (p_mode == TINYGLTF_MODE_TRIANGLES) {
		p_indices.resize(p_indices.size() / 3 * 3);
		return p_indices;
	}
	std::vector<uint32_t> triangles;
	for (size_t first = 0; first + 2 < p_indices.size(); ++first) {
		const uint32_t *corners = &p_indices[first];
		const bool is_strip = p_mode == TINYGLTF_MODE_TRIANGLE_STRIP;
		const uint32_t a = is_strip ? corners[0] : corners[1];
		const uint32_t b = !is_strip ? corners[2] : first % 2 == 0 ? corners[1] : corners[2];
		const uint32_t c = !is_strip ? p_indices[0] : first % 2 == 0 ? corners[2] : corners[1];
		if (a != b && b != c && c != a) {
			triangles.insert(triangles.end(), { a, b, c });
		}
	}
	return triangles;
}

/// Above this ratio of vertices to indices, sorting the indices is faster than a table of all
/// vertices.
const size_t TABLE_VERTICES_PER_INDEX = 16;

/// Returns the vertices that triangles use, in order, and renumbers the triangles' indices to
/// match. The number of indices bounds the cost, because many primitives may share a large array of
/// vertices. Not called for a primitive with at least as many indices as vertices, see
/// load_primitive.
std::vector<uint32_t> find_used_vertices(size_t p_vertex_count, std::vector<uint32_t> &r_indices) {
	std::vector<uint32_t> used;
	if (r_indices.size() * TABLE_VERTICES_PER_INDEX < p_vertex_count) {
		used = r_indices;
		std::sort(used.begin(), used.end());
		used.erase(std::unique(used.begin(), used.end()), used.end());
		for (uint32_t &index : r_indices) {
			const auto found = std::lower_bound(used.begin(), used.end(), index);
			index = static_cast<uint32_t>(found - used.begin());
		}
		return used;
	}
	const uint32_t UNUSED = UINT32_MAX;
	std::vector<uint32_t> new_index(p_vertex_count, UNUSED);
	for (const uint32_t index : r_indices) {
		new_index[index] = 0; // used; numbered below
	}
	for (uint32_t old = 0; old < new_index.size(); ++old) {
		if (new_index[old] != UNUSED) {
			new_index[old] = static_cast<uint32_t>(used.size());
			used.push_back(old);
		}
	}
	for (uint32_t &index : r_indices) {
		index = new_index[index];
	}
	return used;
}

template <typename T>
std::vector<T> gather(const std::vector<T> &p_vectors, const std::vector<uint32_t> &p_indices) {
	if (p_vectors.empty()) {
		return {};
	}
	std::vector<T> gathered;
	gathered.reserve(p_indices.size());
	for (const uint32_t index : p_indices) {
		gathered.push_back(p_vectors[index]);
	}
	return gathered;
}

} // namespace

GltfMeshes::GltfMeshes(const GltfObject &p_root, const tinygltf::Model &p_model,
		GltfAccessors &p_accessors, GltfTextures &p_textures) :
		model(p_model),
		accessors(p_accessors), textures(p_textures), messages(p_root.get_messages()) {
	const size_t texture_count = p_root.get_count("textures");
	p_root.for_each("materials", [&](const GltfObject &p_material) {
		read_materials.push_back(read_material(p_material, read_materials.size(), texture_count));
	});
	for (const tinygltf::Node &node : model.nodes) {
		if (node.skin >= 0) {
			skinned_meshes.insert(node.mesh);
		}
	}
}

const std::vector<MeshInstance3D::Surface> &GltfMeshes::load_mesh(size_t p_index) {
	if (const auto found = meshes.find(p_index); found != meshes.end()) {
		return found->second;
	}
	const tinygltf::Mesh &mesh = model.meshes[p_index];
	// make_name also truncates the name, of which each primitive stores a copy.
	const std::string name = make_name(mesh.name, text("Mesh ", p_index));
	std::vector<MeshInstance3D::Surface> surfaces;
	for (size_t index = 0; index < mesh.primitives.size(); ++index) {
		const tinygltf::Primitive &primitive = mesh.primitives[index];
		const auto material = load_material(primitive);
		const auto triangles =
				load_primitive(primitive, text("meshes[", p_index, "].primitives[", index, "]"),
						*material, mesh.primitives.size() == 1 ? name : text(name, " ", index),
						skinned_meshes.contains(static_cast<int>(p_index)));
		if (triangles) {
			surfaces.push_back({ triangles, material });
			primitive_indices[triangles.get()] = index;
		}
	}
	return meshes.emplace(p_index, std::move(surfaces)).first->second;
}

void GltfMeshes::check_finite(size_t p_accessor_index, const std::vector<glm::vec3> &p_positions,
		const std::string &p_path, const std::string &p_name) {
	if (!finite_accessors.insert(p_accessor_index).second) {
		return;
	}
	for (size_t index = 0; index < p_positions.size(); ++index) {
		const glm::vec3 &position = p_positions[index];
		if (!std::isfinite(position.x) || !std::isfinite(position.y) ||
				!std::isfinite(position.z)) {
			messages.fail(p_path + ".attributes.POSITION",
					text("of mesh \"", p_name, "\": vertex ", index,
							" is not finite. Correct it or export the file again."));
		}
	}
}

std::shared_ptr<const Mesh> GltfMeshes::load_primitive(const tinygltf::Primitive &p_primitive,
		const std::string &p_path, const Material &p_material, std::string p_name,
		bool p_has_skin) {
	if (p_primitive.mode < TINYGLTF_MODE_TRIANGLES) {
		messages.warn("mode", p_path, "has points or lines; only triangles are drawn.");
		return nullptr;
	}
	const auto position_attribute = p_primitive.attributes.find("POSITION");
	if (position_attribute == p_primitive.attributes.end()) {
		messages.warn("positions", p_path, "has no POSITION; it is skipped.");
		return nullptr;
	}
	// Shared, not copied: a file of a few kilobytes may have a thousand primitives that use one
	// array.
	const size_t positions_index = static_cast<size_t>(position_attribute->second);
	const auto all_positions = accessors.read_vectors(positions_index);
	check_finite(positions_index, *all_positions, p_path, p_name);
	std::shared_ptr<const std::vector<glm::vec3>> all_normals;
	if (const auto found = p_primitive.attributes.find("NORMAL");
			found != p_primitive.attributes.end()) {
		all_normals = accessors.read_vectors(static_cast<size_t>(found->second));
		if (all_normals->size() != all_positions->size()) {
			messages.fail(p_path + ".attributes.NORMAL",
					text("has ", all_normals->size(), " elements, must be ", all_positions->size(),
							", one per POSITION. Export the file again."));
		}
	}
	std::vector<uint32_t> indices;
	if (p_primitive.indices >= 0) {
		indices = accessors.read_indices(
				static_cast<size_t>(p_primitive.indices), all_positions->size());
	} else {
		indices.resize(all_positions->size());
		std::iota(indices.begin(), indices.end(), 0u);
	}
	indices = make_triangles(std::move(indices), p_primitive.mode);
	if (indices.empty()) {
		return nullptr;
	}
	MeshAttributes attributes =
			read_attributes(p_primitive, p_path, p_material, all_positions->size());
	MeshRig rig =
			read_rig(p_primitive, p_path, p_has_skin, all_positions->size(), accessors, messages);
	check_target_limit(rig, p_path);
	std::vector<glm::vec3> positions;
	std::vector<glm::vec3> normals;
	if (indices.size() >= all_positions->size()) {
		// Unused vertices are not searched for: the mesh may contain some, and its bounds enclose
		// them too.
		positions = *all_positions;
		normals = all_normals ? *all_normals : normals;
	} else {
		const std::vector<uint32_t> used = find_used_vertices(all_positions->size(), indices);
		positions = gather(*all_positions, used);
		normals = all_normals ? gather(*all_normals, used) : normals;
		for (std::vector<glm::vec2> &uvs : attributes.uvs) {
			uvs = gather(uvs, used);
		}
		attributes.tangents = gather(attributes.tangents, used);
		attributes.colors = gather(attributes.colors, used);
		rig = gather_rig(rig, used);
	}
	vertex_count += positions.size();
	index_count += indices.size();
	if (vertex_count > GLTF_MAX_VERTEX_COUNT || index_count > GLTF_MAX_INDEX_COUNT) {
		messages.fail(p_path + ".attributes",
				text("makes ", vertex_count, " vertices and ", index_count,
						" indices in all, must be at most ", GLTF_MAX_VERTEX_COUNT, " and ",
						GLTF_MAX_INDEX_COUNT, ". Split the scene."));
	}
	if (rig.influence_count > 0 || !rig.targets.empty()) {
		attributes.rig = make_mesh_rig(std::move(rig), positions,
				messages.describe(p_path, text("of mesh \"", p_name, "\"")));
	}
	return make_mesh(std::move(p_name), std::move(positions), std::move(normals),
			std::move(indices), std::move(attributes));
}

void GltfMeshes::check_target_limit(const MeshRig &p_rig, const std::string &p_path) {
	for (const MorphTarget &target : p_rig.targets) {
		target_vector_count +=
				target.positions.size() + target.normals.size() + target.tangents.size();
	}
	if (target_vector_count > GLTF_MAX_VERTEX_COUNT) {
		messages.fail(p_path + ".targets",
				text("make ", target_vector_count, " vectors in all meshes, must be at most ",
						GLTF_MAX_VERTEX_COUNT, ". Split the scene."));
	}
}

MeshAttributes GltfMeshes::read_attributes(const tinygltf::Primitive &p_primitive,
		const std::string &p_path, const Material &p_material, size_t p_count) {
	MeshAttributes attributes;
	const auto read = [&](const std::string &p_name, int p_min_components, int p_max_components) {
		std::vector<glm::vec4> values;
		const auto found = p_primitive.attributes.find(p_name);
		if (found != p_primitive.attributes.end()) {
			values = accessors.read_attribute(
					static_cast<size_t>(found->second), p_min_components, p_max_components);
			if (values.size() != p_count) {
				messages.fail(text(p_path, ".attributes.", p_name),
						text("has ", values.size(), " elements, must be ", p_count,
								", one per POSITION. Export the file again."));
			}
			for (glm::vec4 &value : values) {
				for (int axis = 0; axis < 4; ++axis) {
					value[axis] = std::isfinite(value[axis]) ? value[axis] : 0.0f;
				}
			}
		}
		return values;
	};
	attributes.colors = read("COLOR_0", 3, 4);
	for (const Texture *texture : p_material.list_textures()) {
		std::vector<glm::vec2> &uvs = attributes.uvs[texture->uv_set];
		if (!texture->image || !uvs.empty()) {
			continue;
		}
		const std::string name = text("TEXCOORD_", texture->uv_set);
		const std::vector<glm::vec4> values = read(name, 2, 2);
		uvs.assign(values.begin(), values.end());
		if (uvs.empty()) {
			messages.report(messages.describe(p_path + ".attributes",
					text("has no ", name,
							", which its material's textures need: they show one texel. "
							"Unwrap the mesh, or export the file again.")));
			uvs.assign(p_count, glm::vec2(0.0f));
		}
	}
	if (p_material.normal_texture.image) {
		attributes.tangents = read("TANGENT", 4, 4);
	}
	return attributes;
}

std::shared_ptr<const Material> GltfMeshes::load_material(const tinygltf::Primitive &p_primitive) {
	if (p_primitive.material < 0) {
		// glTF's default material is metallic, on which shadows are not visible. This one is plain
		// grey instead.
		return default_material;
	}
	const size_t index = static_cast<size_t>(p_primitive.material);
	std::shared_ptr<const Material> &material = materials[index];
	if (!material) {
		material = std::make_shared<const Material>(
				load_material_textures(read_materials[index], textures, messages));
	}
	return material;
}

} // namespace gnomon
