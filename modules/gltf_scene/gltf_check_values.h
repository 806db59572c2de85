#pragma once

#include "modules/gltf_scene/gltf_json.h"

#include <cstdint>
#include <string_view>

namespace gnomon {

// Helpers of the document checks. Those that check a value convert it to a form that tinygltf
// accepts, or throw an Error with the value's JSON path and allowed range.

/// Checks a whole number in p_minimum..p_maximum. The check_ functions accept a missing value, the
/// require_ functions do not. A number written as "3.0" is rewritten, because tinygltf rejects it.
void check_integer(
		const GltfObject &p_object, std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum);
void require_integer(
		const GltfObject &p_object, std::string_view p_key, uint64_t p_minimum, uint64_t p_maximum);
/// Checks an index into an array of p_count elements.
void check_index(const GltfObject &p_object, std::string_view p_key, size_t p_count);
void require_index(const GltfObject &p_object, std::string_view p_key, size_t p_count);
/// Checks an array of such indices, which may be missing.
void check_indices(const GltfObject &p_object, std::string_view p_key, size_t p_count);

} // namespace gnomon
