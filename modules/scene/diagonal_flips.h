#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace gnomon {

/// Flips diagonals of a triangulation (Lawson, "Software for C1 surface interpolation", in
/// Mathematical Software III, 1977) while this makes them shorter. A plane sweep leaves narrow
/// triangles across the whole polygon; compact ones cover fewer texels of a map. The triangulation
/// covers the same area and has the same points. r_triangles: three indices into p_points per
/// triangle, counterclockwise.
void shorten_diagonals(std::span<const glm::ivec2> p_points, std::vector<uint32_t> &r_triangles);

} // namespace gnomon
