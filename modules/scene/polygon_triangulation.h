#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// A closed line of distinct points, with the inside to its left where y grows upwards: outer
/// borders run counterclockwise, holes clockwise.
using PolygonLoop = std::vector<glm::ivec2>;

/// Largest coordinate, either side of 0: products of differences fit 64 bits.
constexpr int32_t MAX_POLYGON_COORDINATE = 1 << 29;

/// Above 0: c lies to the left of the line from a to b. Twice the triangle's area, exact.
int64_t compute_turn(const glm::ivec2 &p_a, const glm::ivec2 &p_b, const glm::ivec2 &p_c);

/// Three indices a triangle, into the loops' points one after another, counterclockwise; no points
/// are added. Sweep over monotone pieces (de Berg et al., Computational Geometry, 2008, chapter 3)
/// in exact arithmetic. Loops that cross or touch each other have no inside that is well defined:
/// the result is then empty.
std::vector<uint32_t> triangulate(std::span<const PolygonLoop> p_loops);

} // namespace gnomon
