#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace gnomon {

/// Quantises points within bounds to the cells of a Hilbert curve through the cube around them, so
/// that points that are consecutive along the curve are close to each other.
class HilbertCurve {
public:
	/// p_bits: the curve has 2^p_bits cells per axis, at most 21. The bounds may be empty or flat.
	HilbertCurve(const glm::dvec3 &p_minimum, const glm::dvec3 &p_maximum, uint32_t p_bits);

	/// The position along the curve of the cell that contains the point, which must be in the
	/// bounds.
	uint64_t find_position(const glm::dvec3 &p_point) const;

private:
	glm::dvec3 minimum;
	double cells_per_unit;
	uint32_t bits;
};

} // namespace gnomon
