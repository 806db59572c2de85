#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// A computed mask and an estimate of its error.
struct ReferenceVisibility {
	/// v in 0..1, one per pixel. 0 where nothing was computed.
	std::vector<float> visibility;
	/// RGB visibility when casters are translucent; `visibility` is then its luminance. Else empty.
	std::vector<glm::vec3> colors;
	/// Standard error of v, the mean over all samples: the root mean square over the penumbra
	/// pixels (0.002 < v < 0.998) of |A - B| sqrt(a b) / (a + b), where A and B are the means of
	/// the two halves of a pixel's samples, of a and b samples. The halves are scrambled
	/// independently, so the estimate is unbiased (halves of one stratified set would fill each
	/// other's gaps and overstate it). 0 without penumbra pixels or for a hard shadow; -1, unknown,
	/// for a single sample.
	float standard_error = 0.0f;
	uint64_t penumbra_pixel_count = 0;
};

/// Serialises a reference for the cache.
std::vector<uint8_t> build_reference_entry(uint64_t p_key, const ReferenceVisibility &p_reference);
/// Parses the bytes of build_reference_entry. Returns nothing when their key or size differs.
/// p_is_colored: whether the entry must have colours.
std::optional<ReferenceVisibility> parse_reference_entry(
		std::span<const uint8_t> p_bytes, uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

/// Stores a reference in the cache folder under its key. When that fails, it only logs a warning.
void save_reference(uint64_t p_key, const ReferenceVisibility &p_reference);
/// Loads a stored reference, see parse_reference_entry. Returns nothing when it is absent or
/// damaged.
std::optional<ReferenceVisibility> load_reference(
		uint64_t p_key, size_t p_pixel_count, bool p_is_colored);

} // namespace gnomon
