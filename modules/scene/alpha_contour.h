#pragma once

#include "modules/scene/alpha_test.h"
#include "modules/scene/polygon_triangulation.h"

#include <optional>
#include <vector>

namespace gnomon {

/// Of a texel's side, in which loops have their points.
const int32_t CONTOUR_UNITS_PER_TEXEL = 256;

/// Loops around the region of one tile where the interpolated alpha is at least the cutoff, by
/// marching squares. Nothing: more than so many segments.
std::optional<std::vector<PolygonLoop>> find_alpha_contour(
		const AlphaTest &p_test, size_t p_most_segments);
/// The same along the sides of texels, as a nearest sampler shows them. Texels that meet in a point
/// are parted there.
std::optional<std::vector<PolygonLoop>> find_alpha_squares(
		const AlphaTest &p_test, size_t p_most_segments);

} // namespace gnomon
