#pragma once

#include "modules/gltf_scene/gltf_buffers.h"
#include "modules/gltf_scene/gltf_json.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// Reads accessors, checking types, counts, strides and bounds, whatever the file claims. Sparse
/// ones and the integer formats of KHR_mesh_quantization are included.
class GltfAccessors {
public:
	/// The arguments must outlive this object.
	GltfAccessors(
			const tinygltf::Model &p_model, GltfBuffers &p_buffers, const GltfMessages &p_messages);

	/// Reads a VEC3 of floats or of 8- or 16-bit integers, normalized or not. The result is shared,
	/// because exporters often let many primitives use one vertex array.
	std::shared_ptr<const std::vector<glm::vec3>> read_vectors(size_t p_accessor_index);
	/// Reads a VEC2 to VEC4 vertex attribute in the same way, not shared. p_fewest, p_most: allowed
	/// component counts. Missing components are filled from 0, 0, 0, 1.
	std::vector<glm::vec4> read_attribute(size_t p_accessor_index, int p_fewest, int p_most);
	/// Reads floats, or normalized 8- or 16-bit integers, of SCALAR to VEC4 and MAT4, tightly
	/// packed. p_components: components per element.
	std::vector<float> read_floats(size_t p_accessor_index, int p_components);
	/// Reads a SCALAR of unsigned integers, each below p_vertex_count.
	std::vector<uint32_t> read_indices(size_t p_accessor_index, size_t p_vertex_count);

private:
	struct Layout; // of one accessor or its sparse part; all bounds are checked
	enum class Components { NUMBERS, INDICES }; // floats or small integers; unsigned integers
	/// p_fewest, p_most: allowed numbers of components of an element.
	Layout read_layout(size_t p_index, int p_fewest, int p_most,
			Components p_components = Components::NUMBERS);
	/// Finds the elements in a buffer view. p_path: JSON path of the view's index and byte offset.
	void find_bytes(int p_view, size_t p_offset, const std::string &p_path, Layout &r_layout);
	template <typename Convert>
	void read_elements(size_t p_index, const Layout &p_layout, const Convert &p_convert);

	const tinygltf::Model &model;
	GltfBuffers &buffers;
	const GltfMessages &messages;
	uint64_t decoded_count = 0;
	struct CacheEntry {
		size_t accessor_index = SIZE_MAX;
		std::shared_ptr<const std::vector<glm::vec3>> vectors;
	};
	CacheEntry cache[2]; // positions and normals of the primitive before
	size_t oldest_entry = 0;
};

} // namespace gnomon
