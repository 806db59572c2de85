#pragma once

#include "modules/scene/alpha_test.h"
#include "modules/scene/polygon_triangulation.h"

#include <optional>
#include <vector>

namespace gnomon {

/// Loop points are integers; 256 units are the length of a texel's side.
const int32_t CONTOUR_UNITS_PER_TEXEL = 256;

/// Finds loops around the region of one tile (texture coordinates 0..1) where the interpolated
/// alpha is at least the cutoff, by marching squares. Returns nullopt if there are more than
/// p_max_segments segments.
std::optional<std::vector<PolygonLoop>> find_alpha_contour(
		const AlphaTest &p_test, size_t p_max_segments);
/// Does the same for a nearest sampler: the loops follow the sides of texels. Texels that touch
/// only at a corner are separated there.
std::optional<std::vector<PolygonLoop>> find_alpha_squares(
		const AlphaTest &p_test, size_t p_max_segments);

} // namespace gnomon
