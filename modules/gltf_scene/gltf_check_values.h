#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <cstdint>
#include <string_view>

namespace gnomon {

// Helpers of the document checks: each converts a value to a form that tinygltf accepts, or fails.

/// Checks the elements of a list of the document, or of one of its objects.
template <typename Check>
void check_elements(const GltfObject &p_parent, std::string_view p_key, const Check &p_check) {
	const size_t count = p_parent.get_count(p_key);
	for (size_t index = 0; index < count; ++index) {
		p_check(p_parent.get_element(p_key, index));
	}
}

/// Checks a whole number, which may be written with a fraction of zero ("3.0"); tinygltf rejects
/// that form, so it is rewritten.
void check_integer(
		const GltfObject &p_object, std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum);
void require_integer(
		const GltfObject &p_object, std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum);
void check_index(const GltfObject &p_object, std::string_view p_key, size_t p_count);
void require_index(const GltfObject &p_object, std::string_view p_key, size_t p_count);
void check_indices(const GltfObject &p_object, std::string_view p_key, size_t p_count);

} // namespace gnomon
