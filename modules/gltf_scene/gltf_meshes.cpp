#include "modules/gltf_scene/gltf_meshes.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_materials.h"

#include <tiny_gltf.h>

#include <cmath>

namespace gnomon {

namespace {

/// Three indices per triangle, wound as glTF 2.0, 3.7.2.1 says; an incomplete last one is left out,
/// and so are triangles that a strip only makes to jump.
std::vector<uint32_t> make_triangles(std::vector<uint32_t> p_indices, uint64_t p_mode) {
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

/// Drops vertices that no triangle uses: many primitives may share one large array.
void keep_used_vertices(std::vector<glm::vec3> &r_positions, std::vector<glm::vec3> &r_normals,
		std::vector<uint32_t> &r_indices) {
	if (r_indices.size() >= r_positions.size()) {
		return;
	}
	const uint32_t UNUSED = UINT32_MAX;
	std::vector<uint32_t> new_index(r_positions.size(), UNUSED);
	for (const uint32_t index : r_indices) {
		new_index[index] = 0;
	}
	uint32_t used_count = 0;
	for (size_t old = 0; old < new_index.size(); ++old) {
		if (new_index[old] == UNUSED) {
			continue;
		}
		r_positions[used_count] = r_positions[old];
		if (!r_normals.empty()) {
			r_normals[used_count] = r_normals[old];
		}
		new_index[old] = used_count++;
	}
	r_positions.resize(used_count);
	r_positions.shrink_to_fit();
	r_normals.resize(r_normals.empty() ? 0 : used_count);
	r_normals.shrink_to_fit();
	for (uint32_t &index : r_indices) {
		index = new_index[index];
	}
}

} // namespace

GltfMeshes::GltfMeshes(const GltfObject &p_root, GltfAccessors &p_accessors) :
		root(p_root), accessors(p_accessors) {}

const std::vector<MeshInstance3D::Surface> &GltfMeshes::load_mesh(size_t p_index) {
	if (const auto found = meshes.find(p_index); found != meshes.end()) {
		return found->second;
	}
	const GltfObject mesh = root.get_element("meshes", p_index);
	const size_t primitive_count = mesh.get_count("primitives");
	std::string name = mesh.get_text("name");
	if (name.empty()) {
		name = text("Mesh ", p_index);
	}
	std::vector<MeshInstance3D::Surface> surfaces;
	for (size_t index = 0; index < primitive_count; ++index) {
		const GltfObject primitive = mesh.get_element("primitives", index);
		const auto triangles =
				load_primitive(primitive, primitive_count == 1 ? name : text(name, " ", index));
		if (triangles) {
			surfaces.push_back({ triangles, load_material(primitive) });
			primitive_indices[triangles.get()] = index;
		}
	}
	return meshes.emplace(p_index, std::move(surfaces)).first->second;
}

std::shared_ptr<const Mesh> GltfMeshes::load_primitive(
		const GltfObject &p_primitive, std::string p_name) {
	GltfMessages &messages = p_primitive.get_messages();
	const uint64_t mode =
			p_primitive.find_integer("mode", TINYGLTF_MODE_POINTS, TINYGLTF_MODE_TRIANGLE_FAN)
					.value_or(TINYGLTF_MODE_TRIANGLES);
	if (mode < TINYGLTF_MODE_TRIANGLES) {
		messages.warn(
				"mode", p_primitive.get_path(), "has points or lines; only triangles are drawn.");
		return nullptr;
	}
	if (p_primitive.get_count("targets") > 0) {
		messages.warn("targets", p_primitive.get_path(), "has morph targets; they are not read.");
	}
	const GltfObject attributes = p_primitive.require_object("attributes");
	const size_t accessor_count = root.get_count("accessors");
	const std::optional<size_t> positions_index = attributes.find_index("POSITION", accessor_count);
	if (!positions_index) {
		messages.warn("positions", p_primitive.get_path(), "has no POSITION; it is left out.");
		return nullptr;
	}
	std::vector<glm::vec3> positions = *accessors.read_vectors(*positions_index);
	for (size_t index = 0; index < positions.size(); ++index) {
		const glm::vec3 &position = positions[index];
		if (!std::isfinite(position.x) || !std::isfinite(position.y) ||
				!std::isfinite(position.z)) {
			attributes.fail_at("POSITION",
					text("of mesh \"", p_name, "\": vertex ", index,
							" is not finite. Correct it or export the file again."));
		}
	}
	std::vector<glm::vec3> normals;
	if (const std::optional<size_t> index = attributes.find_index("NORMAL", accessor_count)) {
		normals = *accessors.read_vectors(*index);
		if (normals.size() != positions.size()) {
			attributes.fail_at("NORMAL",
					text("has ", normals.size(), " elements, must be ", positions.size(),
							", one per POSITION. Export the file again."));
		}
	}
	std::vector<uint32_t> indices;
	if (const std::optional<size_t> index = p_primitive.find_index("indices", accessor_count)) {
		indices = accessors.read_indices(*index, positions.size());
	} else {
		for (uint32_t vertex = 0; vertex < positions.size(); ++vertex) {
			indices.push_back(vertex);
		}
	}
	indices = make_triangles(std::move(indices), mode);
	if (indices.empty()) {
		return nullptr;
	}
	keep_used_vertices(positions, normals, indices);
	vertex_count += positions.size();
	index_count += indices.size();
	if (vertex_count > GLTF_MAX_VERTEX_COUNT || index_count > GLTF_MAX_INDEX_COUNT) {
		p_primitive.fail_at("attributes",
				text("makes ", vertex_count, " vertices and ", index_count,
						" indices in all, must be at most ", GLTF_MAX_VERTEX_COUNT, " and ",
						GLTF_MAX_INDEX_COUNT, ". Split the scene."));
	}
	return make_mesh(
			std::move(p_name), std::move(positions), std::move(normals), std::move(indices));
}

std::shared_ptr<const Material> GltfMeshes::load_material(const GltfObject &p_primitive) {
	const std::optional<size_t> index =
			p_primitive.find_index("material", root.get_count("materials"));
	if (!index) {
		// glTF's own default is metal, which shows no shadow of a light; plain grey does.
		return default_material;
	}
	std::shared_ptr<const Material> &material = materials[*index];
	if (!material) {
		material = std::make_shared<const Material>(
				read_material(root.get_element("materials", *index), int(*index)));
	}
	return material;
}

} // namespace gnomon
