#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// A computed mask and what is known of its precision.
struct ReferenceVisibility {
	/// v in 0..1, one per pixel. 0 where nothing was computed.
	std::vector<float> visibility;
	/// Where casters are translucent: of each colour; visibility is then its luminance. Else empty.
	std::vector<glm::vec3> colors;
	/// Of the mean over all samples: root mean square over the penumbra pixels (0.002 < v < 0.998)
	/// of |A - B| sqrt(a b) / (a + b), where A and B are the means of the pixel's two halves of a
	/// and b samples. The halves are scrambled independently, so the estimate is unbiased (halves
	/// of one stratified set would fill each other's gaps and overstate it). 0 without penumbra
	/// pixels or for a hard shadow; -1, unknown, for a single sample.
	float standard_error = 0.0f;
	uint64_t penumbra_pixel_count = 0;
};

/// The bytes that the cache keeps of a reference.
std::vector<uint8_t> build_reference_entry(uint64_t p_key, const ReferenceVisibility &p_reference);
/// The reference in such bytes; nothing when they are of another key or size. p_is_colored: whether
/// it must have colours.
std::optional<ReferenceVisibility> parse_reference_entry(
		std::span<const uint8_t> p_bytes, uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

/// Stores a reference in the cache folder under its key. A failure to write only warns.
void save_reference(uint64_t p_key, const ReferenceVisibility &p_reference);
/// The stored reference, as parse_reference_entry reads it; nothing when absent or damaged.
std::optional<ReferenceVisibility> load_reference(
		uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

} // namespace gnomon
