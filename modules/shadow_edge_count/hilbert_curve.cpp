#include "modules/shadow_edge_count/hilbert_curve.h"

#include <algorithm>
#include <limits>

namespace gnomon {

namespace {

/// A cell's position along a Hilbert curve, whose consecutive cells are neighbours. Skilling 2004,
/// "Programming the Hilbert curve", AIP Conference Proceedings 707.
uint64_t find_curve_position(const glm::uvec3 &p_cell, uint32_t p_bits) {
	glm::uvec3 bits = p_cell;
	for (uint32_t bit = 1u << (p_bits - 1); bit > 1; bit >>= 1) {
		const uint32_t lower = bit - 1;
		for (int axis = 0; axis < 3; ++axis) {
			if ((bits[axis] & bit) != 0) {
				bits.x ^= lower; // mirrors the curve below this level
			} else {
				const uint32_t change = (bits.x ^ bits[axis]) & lower; // swaps two axes
				bits.x ^= change;
				bits[axis] ^= change;
			}
		}
	}
	bits.y ^= bits.x; // Gray code
	bits.z ^= bits.y;
	uint32_t change = 0;
	for (uint32_t bit = 1u << (p_bits - 1); bit > 1; bit >>= 1) {
		change ^= (bits.z & bit) != 0 ? bit - 1 : 0;
	}
	bits ^= change;
	uint64_t position = 0;
	for (uint32_t bit = 1u << (p_bits - 1); bit > 0; bit >>= 1) {
		for (int axis = 0; axis < 3; ++axis) {
			position = position << 1 | ((bits[axis] & bit) != 0 ? 1u : 0u);
		}
	}
	return position;
}

} // namespace

HilbertCurve::HilbertCurve(
		const glm::dvec3 &p_minimum, const glm::dvec3 &p_maximum, uint32_t p_bits) :
		minimum(p_minimum),
		bits(p_bits) {
	const glm::dvec3 size = p_maximum - p_minimum;
	cells_per_unit = ((1u << bits) - 1) /
			std::max({ size.x, size.y, size.z, std::numeric_limits<double>::min() });
}

uint64_t HilbertCurve::find_position(const glm::dvec3 &p_point) const {
	return find_curve_position(glm::uvec3((p_point - minimum) * cells_per_unit), bits);
}

} // namespace gnomon
