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

/// Twice the signed area of the triangle a, b, c, exact; positive if c lies left of the line from a
/// to b.
int64_t compute_turn(const glm::ivec2 &p_a, const glm::ivec2 &p_b, const glm::ivec2 &p_c);

/// Returns three indices per triangle, into the concatenated points of the loops, counterclockwise;
/// adds no points. Sweeps over monotone pieces (de Berg et al., Computational Geometry, 2008,
/// chapter 3) in exact arithmetic. If loops cross or touch each other, the inside is not well
/// defined and the result is empty.
std::vector<uint32_t> triangulate(std::span<const PolygonLoop> p_loops);

} // namespace gnomon
