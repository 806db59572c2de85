#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// A computed mask and what is known of its precision.
struct Truth {
	std::vector<float> visibility;
	std::vector<glm::vec3> colors; // see VisibilityResult
	float standard_error = 0;	   // see VisibilityResult
	uint64_t penumbra_pixel_count = 0;
};

/// The bytes that the cache keeps of a truth.
std::vector<uint8_t> build_truth_entry(uint64_t p_key, const Truth &p_truth);
/// The truth in such bytes; nothing when they are of another key or size. p_is_colored: whether it
/// must have colours.
std::optional<Truth> parse_truth_entry(
		std::span<const uint8_t> p_bytes, uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

} // namespace gnomon
