#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A closed line of distinct points, with the inside to its left where y grows upwards: outer
/// borders run counterclockwise, holes clockwise.
using PolygonLoop = std::vector<glm::ivec2>;

/// Largest absolute coordinate: products of differences fit in 64 bits.
constexpr int32_t MAX_POLYGON_COORDINATE = 1 << 29;

/// Returns twice the signed area of the triangle a, b, c, exactly; positive if c is to the left of
/// the line from a to b.
int64_t compute_twice_signed_area(
		const glm::ivec2 &p_a, const glm::ivec2 &p_b, const glm::ivec2 &p_c);

/// Returns three indices per triangle, into the concatenated points of the loops, counterclockwise;
/// adds no points. Sweeps over monotone pieces (de Berg et al., Computational Geometry, 2008,
/// chapter 3) in exact arithmetic, then flips diagonals to shorter ones. The result is empty if a
/// loop has fewer than three points, or if loops cross or touch themselves or each other, so that
/// the inside is not well defined.
std::vector<uint32_t> triangulate(std::span<const PolygonLoop> p_loops);

} // namespace gnomon
