#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/scene/nodes.h"

#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// Appends meshes and materials to a document's JSON, each once. Their bytes are collected for one
/// buffer, which the caller stores.
class GltfMeshWriter {
public:
	/// p_buffer_index, p_first_byte: where the bytes will stand. r_json must outlive it.
	GltfMeshWriter(Json &r_json, size_t p_buffer_index, size_t p_first_byte,
			std::map<const Material *, size_t> p_material_indices);
	/// Index of the new mesh. p_surfaces is not empty.
	size_t append_mesh(
			const std::string &p_name, const std::vector<MeshInstance3D::Surface> &p_surfaces);
	const std::vector<uint8_t> &get_bytes() const { return bytes; }

private:
	struct Accessors {
		size_t positions = 0;
		size_t normals = 0;
		size_t indices = 0;
	};
	Accessors append_vertices(const Mesh &p_mesh);
	size_t append_accessor(
			std::span<const uint8_t> p_data, size_t p_count, Json p_accessor, int p_target);
	size_t append_material(const Material &p_material);

	Json &json;
	size_t buffer_index;
	size_t first_byte;
	std::vector<uint8_t> bytes;
	std::map<const Mesh *, Accessors> accessors;
	std::map<const Material *, size_t> material_indices;
};

/// Names an extension in `extensionsUsed`, once.
void declare_extension(Json &r_json, const std::string &p_name);

} // namespace gnomon
