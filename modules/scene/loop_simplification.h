#pragma once

#include "modules/scene/polygon_triangulation.h"

namespace gnomon {

/// Simplifies loops that neither cross nor touch. Lengths are in units of the loops' points. Points
/// are dropped if the remaining lines stay within p_tolerance of them; where lines would meet,
/// points are restored, so that the result neither crosses nor touches itself, and where they would
/// pass over a whole loop, so that each hole remains within its border. Then the remaining
/// points are moved along the loop, and from it by at most twice the tolerance, so that the lines
/// between them fit it by least squares. Each loop keeps its area, up to 0.2 % and to rounding: a
/// loop whose moved lines would meet others is not moved if it has the area without, and otherwise
/// gets a smaller tolerance, as does each loop that would lose area. Points on the border of the
/// rectangle from (0, 0) to p_size stay, except those within a straight line along it.
std::vector<PolygonLoop> simplify_loops(
		const std::vector<PolygonLoop> &p_loops, int32_t p_tolerance, const glm::ivec2 &p_size);

} // namespace gnomon
