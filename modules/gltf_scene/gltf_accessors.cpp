#include "modules/gltf_scene/gltf_accessors.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

namespace {

// Limit on all elements read together: a small hostile file could reference the same data many
// times.
const uint64_t MAX_DECODED_COUNT = 4 * GLTF_MAX_INDEX_COUNT;
// Limit on the elements of an accessor without bufferView. They are all zero and need no bytes in
// the file, so that nothing else limits their number.
const uint64_t MAX_ZERO_COUNT = uint64_t(1) << 22;

bool is_attribute_type(int p_component_type) {
	return p_component_type == TINYGLTF_COMPONENT_TYPE_FLOAT ||
			(p_component_type >= TINYGLTF_COMPONENT_TYPE_BYTE &&
					p_component_type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
}

bool is_index_type(int p_component_type) {
	return p_component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
			p_component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
			p_component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::string describe_type(int p_type) {
	const int32_t count = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(p_type));
	const bool is_matrix = p_type >= TINYGLTF_TYPE_MAT2 && p_type <= TINYGLTF_TYPE_MAT4;
	return p_type == TINYGLTF_TYPE_SCALAR ? "\"SCALAR\""
			: is_matrix					  ? text("\"MAT", p_type - TINYGLTF_TYPE_MAT2 + 2, "\"")
										  : text("\"VEC", count, "\"");
}

/// Returns for example "\"VEC3\" or \"VEC4\"".
std::string describe_types(int p_min_components, int p_max_components) {
	const auto describe = [](int p_count) {
		return describe_type(p_count == 1 ? TINYGLTF_TYPE_SCALAR
						: p_count == 16	  ? TINYGLTF_TYPE_MAT4
										  : p_count); // TINYGLTF_TYPE_VEC2 is 2, and so on
	};
	return p_min_components == p_max_components
			? describe(p_max_components)
			: describe(p_min_components) + " or " + describe(p_max_components);
}

size_t get_component_bytes(int p_component_type) {
	return static_cast<size_t>(
			tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(p_component_type)));
}

template <typename T> T load(const uint8_t *p_bytes) {
	T value;
	std::memcpy(&value, p_bytes, sizeof(value)); // some exporters do not align accessors
	return value;
}

/// Decodes normalized integers as glTF 2.0 defines: of signed bytes, both -127 and -128 become -1.
template <typename T> float to_float(const uint8_t *p_bytes, bool p_is_normalized) {
	const float value = static_cast<float>(load<T>(p_bytes));
	if (!p_is_normalized) {
		return value;
	}
	return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float read_component(const uint8_t *p_bytes, int p_component_type, bool p_is_normalized) {
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

uint32_t read_index(const uint8_t *p_bytes, int p_component_type) {
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
	std::span<const uint8_t> bytes; // from the first element; empty: all elements are zero
	uint64_t count = 0;
	int component_type = 0;
	size_t component_bytes = 0;
	int component_count = 0;
	size_t element_bytes = 0;
	size_t stride_bytes = 0;
	bool is_normalized = false;

	const uint8_t *get_element(size_t p_index) const {
		return bytes.data() + p_index * stride_bytes;
	}
};

GltfAccessors::GltfAccessors(
		const tinygltf::Model &p_model, GltfBuffers &p_buffers, const GltfMessages &p_messages) :
		model(p_model),
		buffers(p_buffers), messages(p_messages) {}

void GltfAccessors::locate_elements(
		int p_view, size_t p_offset, const std::string &p_path, Layout &r_layout) {
	const size_t view_index = static_cast<size_t>(p_view);
	const auto view_bytes = buffers.load_view(model, view_index);
	const size_t stride_bytes = model.bufferViews[view_index].byteStride;
	if (stride_bytes > 0 && stride_bytes < r_layout.element_bytes) {
		messages.fail_value(text("bufferViews[", view_index, "].byteStride"), text(stride_bytes),
				text("at least ", r_layout.element_bytes, ", the bytes of an element"));
	}
	r_layout.stride_bytes = stride_bytes > 0 ? stride_bytes : r_layout.element_bytes;
	// check_accessor limits count to 1..GLTF_MAX_INDEX_COUNT, so that this cannot overflow.
	const uint64_t needed_bytes =
			(r_layout.count - 1) * r_layout.stride_bytes + r_layout.element_bytes;
	if (p_offset > view_bytes.size() || needed_bytes > view_bytes.size() - p_offset) {
		messages.fail(p_path + ".byteOffset",
				text("is ", p_offset, ": ", r_layout.count, " elements need ", needed_bytes,
						" bytes, bufferViews[", view_index, "] has ",
						view_bytes.size() - std::min(p_offset, view_bytes.size()), " there. ",
						EXPORT_AGAIN));
	}
	r_layout.bytes = view_bytes.subspan(p_offset, needed_bytes);
}

GltfAccessors::Layout GltfAccessors::read_layout(
		size_t p_index, int p_min_components, int p_max_components, ComponentTypes p_types) {
	const tinygltf::Accessor &accessor = model.accessors[p_index];
	const std::string path = text("accessors[", p_index, "]");
	const bool is_index = p_types == ComponentTypes::INDICES;
	const int component_count = accessor.type == TINYGLTF_TYPE_SCALAR ? 1
			: accessor.type == TINYGLTF_TYPE_MAT4					  ? 16
			: accessor.type <= TINYGLTF_TYPE_VEC4					  ? accessor.type
																	  : 0;
	if (component_count < p_min_components || component_count > p_max_components) {
		messages.fail_value(path + ".type", describe_type(accessor.type),
				describe_types(p_min_components, p_max_components));
	}
	if (!(is_index ? is_index_type : is_attribute_type)(accessor.componentType)) {
		messages.fail_value(path + ".componentType", text(accessor.componentType),
				is_index ? "5121, 5123 or 5125" : "5120..5123 or 5126");
	}
	Layout layout;
	layout.count = accessor.count;
	layout.component_type = accessor.componentType;
	layout.is_normalized = accessor.normalized;
	layout.component_bytes = get_component_bytes(layout.component_type);
	layout.component_count = component_count;
	layout.element_bytes = layout.component_bytes * size_t(component_count);
	decoded_count += layout.count;
	if (decoded_count > MAX_DECODED_COUNT) {
		messages.fail(path + ".count",
				text("makes more than ", MAX_DECODED_COUNT,
						" elements in all accessors. Split the scene."));
	}
	if (accessor.bufferView >= 0) {
		locate_elements(accessor.bufferView, accessor.byteOffset, path, layout);
	} else if (layout.count > MAX_ZERO_COUNT) {
		messages.fail_value(path + ".count", text(layout.count),
				text("1..", MAX_ZERO_COUNT, " without a bufferView"));
	}
	return layout;
}

/// Calls p_convert(element index, pointer to its bytes or null if it is zero) for all elements, and
/// then again for those that the sparse part replaces.
template <typename Convert>
void GltfAccessors::read_elements(
		size_t p_index, const Layout &p_layout, const Convert &p_convert) {
	for (size_t index = 0; index < p_layout.count; ++index) {
		p_convert(index, p_layout.bytes.empty() ? nullptr : p_layout.get_element(index));
	}
	const auto &sparse = model.accessors[p_index].sparse;
	if (!sparse.isSparse) {
		return;
	}
	const std::string path = text("accessors[", p_index, "].sparse");
	if (!is_index_type(sparse.indices.componentType)) {
		messages.fail_value(path + ".indices.componentType", text(sparse.indices.componentType),
				"5121, 5123 or 5125");
	}
	Layout targets;
	targets.count = static_cast<uint64_t>(sparse.count);
	targets.component_type = sparse.indices.componentType;
	targets.element_bytes = get_component_bytes(targets.component_type);
	locate_elements(sparse.indices.bufferView, static_cast<size_t>(sparse.indices.byteOffset),
			path + ".indices", targets);
	Layout values = p_layout;
	values.count = targets.count;
	locate_elements(sparse.values.bufferView, static_cast<size_t>(sparse.values.byteOffset),
			path + ".values", values);
	for (size_t index = 0; index < targets.count; ++index) {
		const uint32_t target = read_index(targets.get_element(index), targets.component_type);
		if (target >= p_layout.count) {
			messages.fail(text(path, ".indices[", index, "]"),
					text("is ", target, ", must be 0..", p_layout.count - 1, ". ", EXPORT_AGAIN));
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
	const Layout layout = read_layout(p_accessor_index, 3, 3);
	if (layout.count > GLTF_MAX_VERTEX_COUNT) {
		messages.fail_value(text("accessors[", p_accessor_index, "].count"), text(layout.count),
				text("1..", GLTF_MAX_VERTEX_COUNT));
	}
	auto vectors = std::make_shared<std::vector<glm::vec3>>(layout.count, glm::vec3(0.0f));
	read_elements(p_accessor_index, layout, [&](size_t p_index, const uint8_t *p_bytes) {
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
	cache[oldest_entry_index] = { p_accessor_index, vectors };
	oldest_entry_index = 1 - oldest_entry_index;
	return vectors;
}

std::vector<glm::vec4> GltfAccessors::read_attribute(
		size_t p_accessor_index, int p_min_components, int p_max_components) {
	const Layout layout = read_layout(p_accessor_index, p_min_components, p_max_components);
	if (layout.count > GLTF_MAX_VERTEX_COUNT) {
		messages.fail_value(text("accessors[", p_accessor_index, "].count"), text(layout.count),
				text("1..", GLTF_MAX_VERTEX_COUNT));
	}
	std::vector<glm::vec4> values(layout.count, glm::vec4(0, 0, 0, 1));
	read_elements(p_accessor_index, layout, [&](size_t p_index, const uint8_t *p_bytes) {
		for (int axis = 0; p_bytes && axis < layout.component_count; ++axis) {
			values[p_index][axis] = read_component(p_bytes + size_t(axis) * layout.component_bytes,
					layout.component_type, layout.is_normalized);
		}
	});
	return values;
}

std::vector<float> GltfAccessors::read_floats(size_t p_accessor_index, int p_components) {
	const Layout layout = read_layout(p_accessor_index, p_components, p_components);
	if (layout.count > GLTF_MAX_VERTEX_COUNT) {
		messages.fail_value(text("accessors[", p_accessor_index, "].count"), text(layout.count),
				text("1..", GLTF_MAX_VERTEX_COUNT));
	}
	const size_t components = static_cast<size_t>(p_components);
	std::vector<float> values(layout.count * components, 0.0f);
	read_elements(p_accessor_index, layout, [&](size_t p_index, const uint8_t *p_bytes) {
		for (size_t i = 0; p_bytes && i < components; ++i) {
			values[p_index * components + i] = read_component(p_bytes + i * layout.component_bytes,
					layout.component_type, layout.is_normalized);
		}
	});
	return values;
}

std::vector<uint32_t> GltfAccessors::read_indices(size_t p_accessor_index, size_t p_vertex_count) {
	const Layout layout = read_layout(p_accessor_index, 1, 1, ComponentTypes::INDICES);
	std::vector<uint32_t> indices(layout.count, 0);
	read_elements(p_accessor_index, layout, [&](size_t p_index, const uint8_t *p_bytes) {
		indices[p_index] = p_bytes ? read_index(p_bytes, layout.component_type) : 0;
	});
	for (size_t index = 0; index < indices.size(); ++index) {
		if (indices[index] >= p_vertex_count) {
			messages.fail(text("accessors[", p_accessor_index, "][", index, "]"),
					text("is ", indices[index], ", must be 0..", p_vertex_count - 1, ". ",
							EXPORT_AGAIN));
		}
	}
	return indices;
}

} // namespace gnomon
