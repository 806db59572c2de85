#pragma once

#include "modules/scene/polygon_triangulation.h"

namespace gnomon {

/// Simplifies loops that neither cross nor touch. The result stays within p_tolerance of the input
/// and still neither crosses nor touches itself: where segments would meet, points are restored.
/// Then points are moved, by at most twice the tolerance, to preserve areas, except where segments
/// would meet. Points on the border of the rectangle from (0, 0) to p_size stay, except those
/// on a straight line along it.
std::vector<PolygonLoop> simplify_loops(
		const std::vector<PolygonLoop> &p_loops, int32_t p_tolerance, const glm::ivec2 &p_size);

} // namespace gnomon
