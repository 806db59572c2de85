#include "modules/gltf_scene/gltf_check_values.h"

namespace gnomon {

void check_integer(const GltfObject &p_object, std::string_view p_key, uint64_t p_minimum,
		uint64_t p_maximum) {
	if (const auto number = p_object.find_integer(p_key, p_minimum, p_maximum)) {
		p_object.set(p_key, *number);
	}
}

void require_integer(const GltfObject &p_object, std::string_view p_key, uint64_t p_minimum,
		uint64_t p_maximum) {
	p_object.set(p_key, p_object.require_integer(p_key, p_minimum, p_maximum));
}

void check_index(const GltfObject &p_object, std::string_view p_key, size_t p_count) {
	if (const auto index = p_object.find_index(p_key, p_count)) {
		p_object.set(p_key, *index);
	}
}

void require_index(const GltfObject &p_object, std::string_view p_key, size_t p_count) {
	p_object.set(p_key, p_object.require_index(p_key, p_count));
}

void check_indices(const GltfObject &p_object, std::string_view p_key, size_t p_count) {
	const size_t count = p_object.get_count(p_key);
	Json indices = Json::array();
	for (size_t index = 0; index < count; ++index) {
		indices.push_back(p_object.require_index_at(p_key, index, p_count));
	}
	if (p_object.find(p_key)) {
		p_object.set(p_key, std::move(indices));
	}
}

} // namespace gnomon
