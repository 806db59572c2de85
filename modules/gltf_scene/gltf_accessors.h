#pragma once

#include "modules/gltf_scene/gltf_buffers.h"
#include "modules/gltf_scene/gltf_json.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

/// Reads accessors. Types, counts, strides and bounds are all checked; a violation throws an Error.
/// Sparse accessors and the integer formats of KHR_mesh_quantization are supported.
class GltfAccessors {
public:
	/// The arguments must outlive this object.
	GltfAccessors(
			const tinygltf::Model &p_model, GltfBuffers &p_buffers, const GltfMessages &p_messages);

	/// Reads a VEC3 accessor of floats or of 8- or 16-bit integers, normalized or not. The result
	/// is cached and shared, because exporters often let many primitives use one vertex array.
	std::shared_ptr<const std::vector<glm::vec3>> read_vectors(size_t p_accessor_index);
	/// Reads a VEC2 to VEC4 vertex attribute of the same component types, without caching. Missing
	/// components are taken from (0, 0, 0, 1). p_min_components, p_max_components: allowed
	/// numbers of components.
	std::vector<glm::vec4> read_attribute(
			size_t p_accessor_index, int p_min_components, int p_max_components);
	/// Reads an accessor of type SCALAR to VEC4 or MAT4, of the same component types, into tightly
	/// packed floats. p_components: components per element, 1 to 4 or 16.
	std::vector<float> read_floats(size_t p_accessor_index, int p_components);
	/// Reads a SCALAR accessor of unsigned integers. Each must be below p_vertex_count.
	std::vector<uint32_t> read_indices(size_t p_accessor_index, size_t p_vertex_count);

private:
	/// Memory layout of an accessor or of its sparse part. Its bounds have been checked.
	struct Layout;
	/// Allowed component types. NUMBERS: floats and 8- or 16-bit integers. INDICES: unsigned
	/// integers.
	enum class ComponentTypes { NUMBERS, INDICES };
	/// Reads and checks the layout of an accessor. p_min_components, p_max_components:
	/// allowed numbers of components per element.
	Layout read_layout(size_t p_index, int p_min_components, int p_max_components,
			ComponentTypes p_types = ComponentTypes::NUMBERS);
	/// Locates the elements in a buffer view and stores their bytes and stride in r_layout. p_path:
	/// JSON path of the object that holds the byte offset, for messages.
	void locate_elements(int p_view, size_t p_offset, const std::string &p_path, Layout &r_layout);
	template <typename Convert>
	void read_elements(size_t p_index, const Layout &p_layout, const Convert &p_convert);

	const tinygltf::Model &model;
	GltfBuffers &buffers;
	const GltfMessages &messages;
	uint64_t decoded_count = 0; // elements of all accessors read so far
	struct CacheEntry {
		size_t accessor_index = SIZE_MAX;
		std::shared_ptr<const std::vector<glm::vec3>> vectors;
	};
	CacheEntry cache[2]; // usually the positions and normals of the previous primitive
	size_t oldest_entry_index = 0;
};

} // namespace gnomon
