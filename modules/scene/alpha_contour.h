#pragma once

#include "modules/scene/alpha_test.h"
#include "modules/scene/polygon_triangulation.h"

#include <optional>
#include <vector>

namespace gnomon {

/// Loop points are integers in this fraction of a texel's side: 256 units are one texel.
const int32_t CONTOUR_UNITS_PER_TEXEL = 256;

/// Finds loops around the region of one tile where the interpolated alpha is at least the cutoff,
/// by marching squares. Returns nothing when there are more segments than allowed.
std::optional<std::vector<PolygonLoop>> find_alpha_contour(
		const AlphaTest &p_test, size_t p_most_segments);
/// Finds such loops along the sides of texels, as a nearest sampler shows them. Texels that
/// touch only at a corner are separated there.
std::optional<std::vector<PolygonLoop>> find_alpha_squares(
		const AlphaTest &p_test, size_t p_most_segments);

} // namespace gnomon
