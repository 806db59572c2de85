#pragma once

#include "modules/scene/polygon_triangulation.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// Returns for each loop the winding number of all other loops around its first point: 0 for an
/// outer border, 1 for a hole. The loops neither cross nor touch.
std::vector<int> compute_nesting(const std::vector<PolygonLoop> &p_loops);

/// Returns the winding number of a loop around a point that is not on it.
int compute_winding_number(const PolygonLoop &p_loop, const glm::ivec2 &p_point);

} // namespace gnomon
