#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace gnomon {

/// A computed mask and what is known of its precision.
struct Truth {
	std::vector<float> visibility;
	std::vector<glm::vec3> colors; // see VisibilityResult
	float standard_error = 0;	   // see VisibilityResult
	uint64_t penumbra_pixel_count = 0;
};

/// Stores a truth in the cache folder under its key. A failure to write only warns.
void save_truth(uint64_t p_key, const Truth &p_truth);
/// The stored truth of p_pixel_count pixels; nothing when absent, damaged or of another size.
/// p_is_colored: whether it must have colours.
std::optional<Truth> load_truth(uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

} // namespace gnomon
