#pragma once

#include "modules/scene/polygon_triangulation.h"

namespace gnomon {

/// Drops points of loops that neither cross nor touch: what is left is nowhere further than
/// p_tolerance from what was there, and still neither crosses nor touches: where lines would meet,
/// points are taken back. Then points are moved, by at most twice the tolerance, so that areas
/// stay; not where lines would meet by that. Points on the border of the rectangle from 0, 0 to
/// p_size stay, but for those on a straight line along it.
std::vector<PolygonLoop> simplify_loops(
		const std::vector<PolygonLoop> &p_loops, int32_t p_tolerance, const glm::ivec2 &p_size);

} // namespace gnomon
