#include "modules/gltf_scene/gltf_accessors.h"

#include "modules/core/error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>

namespace gnomon {

namespace {

// Reading the same vertices again and again costs a hostile file nothing; it ends here.
const uint64_t MAX_DECODED_COUNT = 4 * GLTF_MAX_INDEX_COUNT;
// Zeros need no bytes in the file, so that nothing else bounds them.
const uint64_t MAX_ZERO_COUNT = uint64_t(1) << 22;
const char NEXT_STEP[] = "Export the file again.";

bool is_vector_type(uint64_t p_component_type) {
	return p_component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ||
			(p_component_type >= TINYGLTF_COMPONENT_TYPE_BYTE &&
					p_component_type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

bool is_index_type(uint64_t p_component_type) {
	return p_component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
			p_component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
			p_component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

uint64_t read_component_type(const GltfObject &p_object, bool (*p_is_allowed)(uint64_t)) {
	const uint64_t type = p_object.require_integer(
			"componentType", TINYGLTF_COMPONENT_TYPE_BYTE, TINYGLTF_COMPONENT_TYPE_FLOAT);
	if (!p_is_allowed(type)) {
		p_object.fail_value("componentType",
				p_is_allowed == is_index_type ? "5121, 5123 or 5125" : "5120..5123 or 5126");
	}
	return type;
}

template <typename T> T load(const uint8_t *p_bytes) {
	T value;
	std::memcpy(&value, p_bytes, sizeof(value)); // accessors of careless exporters are not aligned
	return value;
}

template <typename T> float to_float(const uint8_t *p_bytes, bool p_is_normalized) {
	const float value = static_cast<float>(load<T>(p_bytes));
	if (!p_is_normalized) {
		return value;
	}
	return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float read_component(const uint8_t *p_bytes, uint64_t p_component_type, bool p_is_normalized) {
	switch (p_component_type) {
		case TINYGLTF_COMPONENT_TYPE_BYTE:
			return to_float<int8_t>(p_bytes, p_is_normalized);
		case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
			return to_float<uint8_t>(p_bytes, p_is_normalized);
		case TINYGLTF_COMPONENT_TYPE_SHORT:
			return to_float<int16_t>(p_bytes, p_is_normalized);
		case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
			return to_float<uint16_t>(p_bytes, p_is_normalized);
		default:
			return load<float>(p_bytes);
	}
}

uint32_t read_index(const uint8_t *p_bytes, uint64_t p_component_type) {
	switch (p_component_type) {
		case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
			return *p_bytes;
		case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
			return load<uint16_t>(p_bytes);
		default:
			return load<uint32_t>(p_bytes);
	}
}

} // namespace

struct GltfAccessors::Layout {
	std::span<const uint8_t> bytes; // from the first element; empty = all zero
	uint64_t count = 0;
	uint64_t component_type = 0;
	size_t component_bytes = 0;
	size_t element_bytes = 0;
	size_t stride_bytes = 0;
	bool is_normalized = false;

	const uint8_t *get_element(size_t p_index) const {
		return bytes.data() + p_index * stride_bytes;
	}
	/// Finds the elements in a view; p_object has "bufferView" and "byteOffset".
	void find_bytes(const GltfObject &p_root, GltfBuffers &r_buffers, const GltfObject &p_object);
};

void GltfAccessors::Layout::find_bytes(
		const GltfObject &p_root, GltfBuffers &r_buffers, const GltfObject &p_object) {
	const size_t view_index = p_object.require_index("bufferView", p_root.get_count("bufferViews"));
	const GltfObject view = p_root.get_element("bufferViews", view_index);
	const auto view_bytes = r_buffers.load_view(view);
	stride_bytes = view.find_integer("byteStride", element_bytes, 252).value_or(element_bytes);
	const uint64_t offset = p_object.find_integer("byteOffset", 0, view_bytes.size()).value_or(0);
	const uint64_t needed_bytes = (count - 1) * stride_bytes + element_bytes; // count is below 2^32
	if (needed_bytes > view_bytes.size() - offset) {
		p_object.fail_at("byteOffset",
				text("is ", offset, ": ", count, " elements need ", needed_bytes, " bytes, ",
						view.get_path(), " has ", view_bytes.size() - offset, " there. ",
						NEXT_STEP));
	}
	bytes = view_bytes.subspan(offset, needed_bytes);
}

GltfAccessors::GltfAccessors(const GltfObject &p_root, GltfBuffers &p_buffers) :
		root(p_root), buffers(p_buffers) {}

GltfAccessors::Layout GltfAccessors::read_layout(const GltfObject &p_accessor, Content p_content) {
	const char *type = p_content == Content::VECTORS ? "VEC3" : "SCALAR";
	if (p_accessor.get_text("type") != type) {
		p_accessor.fail_value("type", std::string("\"") + type + "\"");
	}
	Layout layout;
	layout.count = p_accessor.require_integer("count", 1, GLTF_MAX_INDEX_COUNT);
	layout.component_type = read_component_type(
			p_accessor, p_content == Content::VECTORS ? is_vector_type : is_index_type);
	layout.is_normalized = p_accessor.read_bool("normalized", false);
	layout.component_bytes = static_cast<size_t>(
			tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(layout.component_type)));
	layout.element_bytes = layout.component_bytes * (p_content == Content::VECTORS ? 3 : 1);
	decoded_count += layout.count;
	if (decoded_count > MAX_DECODED_COUNT) {
		p_accessor.fail_at("count",
				text("makes more than ", MAX_DECODED_COUNT,
						" elements in all meshes. Split the scene."));
	}
	if (p_accessor.find("bufferView")) {
		layout.find_bytes(root, buffers, p_accessor);
	} else if (layout.count > MAX_ZERO_COUNT) {
		p_accessor.fail_value("count", text("1..", MAX_ZERO_COUNT, " without a bufferView"));
	}
	return layout;
}

/// Calls p_convert(element index, bytes or null for zero) for all elements, then for sparse ones.
template <typename Convert>
void GltfAccessors::read_elements(
		const GltfObject &p_accessor, const Layout &p_layout, const Convert &p_convert) {
	for (size_t index = 0; index < p_layout.count; ++index) {
		p_convert(index, p_layout.bytes.empty() ? nullptr : p_layout.get_element(index));
	}
	const std::optional<GltfObject> sparse = p_accessor.find_object("sparse");
	if (!sparse) {
		return;
	}
	Layout targets;
	const GltfObject indices = sparse->require_object("indices");
	targets.count = sparse->require_integer("count", 1, p_layout.count);
	targets.component_type = read_component_type(indices, is_index_type);
	targets.element_bytes = static_cast<size_t>(
			tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(targets.component_type)));
	targets.find_bytes(root, buffers, indices);
	Layout values = p_layout;
	values.count = targets.count;
	values.find_bytes(root, buffers, sparse->require_object("values"));
	for (size_t index = 0; index < targets.count; ++index) {
		const uint32_t target = read_index(targets.get_element(index), targets.component_type);
		if (target >= p_layout.count) {
			indices.fail_at(text("[", index, "]"),
					text("is ", target, ", must be 0..", p_layout.count - 1, ". ", NEXT_STEP));
		}
		p_convert(target, values.get_element(index));
	}
}

std::shared_ptr<const std::vector<glm::vec3>> GltfAccessors::read_vectors(size_t p_accessor_index) {
	for (const CacheEntry &entry : cache) {
		if (entry.accessor_index == p_accessor_index) {
			return entry.vectors;
		}
	}
	const GltfObject accessor = root.get_element("accessors", p_accessor_index);
	const Layout layout = read_layout(accessor, Content::VECTORS);
	if (layout.count > GLTF_MAX_VERTEX_COUNT) {
		accessor.fail_value("count", text("1..", GLTF_MAX_VERTEX_COUNT));
	}
	auto vectors = std::make_shared<std::vector<glm::vec3>>(layout.count, glm::vec3(0.0f));
	read_elements(accessor, layout, [&](size_t p_index, const uint8_t *p_bytes) {
		glm::vec3 &vector = (*vectors)[p_index];
		if (!p_bytes) {
			return;
		}
		if (layout.component_type == TINYGLTF_COMPONENT_TYPE_FLOAT) {
			vector = load<glm::vec3>(p_bytes);
			return;
		}
		for (int axis = 0; axis < 3; ++axis) {
			vector[axis] = read_component(p_bytes + size_t(axis) * layout.component_bytes,
					layout.component_type, layout.is_normalized);
		}
	});
	cache[oldest_entry] = { p_accessor_index, vectors };
	oldest_entry = 1 - oldest_entry;
	return vectors;
}

std::vector<uint32_t> GltfAccessors::read_indices(size_t p_accessor_index, size_t p_vertex_count) {
	const GltfObject accessor = root.get_element("accessors", p_accessor_index);
	const Layout layout = read_layout(accessor, Content::INDICES);
	std::vector<uint32_t> indices(layout.count, 0);
	read_elements(accessor, layout, [&](size_t p_index, const uint8_t *p_bytes) {
		indices[p_index] = p_bytes ? read_index(p_bytes, layout.component_type) : 0;
	});
	for (size_t index = 0; index < indices.size(); ++index) {
		if (indices[index] >= p_vertex_count) {
			accessor.fail_at(text("[", index, "]"),
					text("is ", indices[index], ", must be 0..", p_vertex_count - 1, ". ",
							NEXT_STEP));
		}
	}
	return indices;
}

} // namespace gnomon
