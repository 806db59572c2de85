#pragma once

#include "modules/scene/alpha_contour.h"
#include "modules/scene/alpha_test.h"
#include "modules/scene/polygon_triangulation.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// The region of a texture where its alpha is at least a cutoff, in one tile: the square 0..1 of
/// its coordinates.
struct AlphaOutline {
	static constexpr int32_t UNITS_PER_TEXEL = CONTOUR_UNITS_PER_TEXEL;

	glm::ivec2 size = glm::ivec2(0); // of the tile in units
	std::vector<glm::ivec2> points;	 // in units, from the image's upper left corner
	std::vector<uint32_t>
			triangles;		 // three points each, all turned one way; none: nothing is there
	bool is_whole = false;	 // all of the tile is there
	uint32_t edge_count = 0; // of its border
	/// 0: the contour itself. Else its squares represent blocks of so many texels a side.
	uint32_t block_size_px = 0;

	bool is_empty() const { return triangles.empty(); }
};

/// The contour by marching squares through texels' centres: crossings are interpolated, a saddle is
/// decided by the mean of its four; simplified without crossings to within p_tolerance_px, texels.
/// At the tile's border it is closed, at the same points on either side where the texture repeats.
/// Of a nearest sampler the squares of its texels, simplified where the tolerance is half of one or
/// more.
///
/// A mask with more edges than p_edge_budget is simplified further, to at most a texel. One that
/// still has more, noise for instance, becomes a half-tone: of each block of texels a square hole
/// or a square that has as much area as the mask has there. The blocks are as small as the budget,
/// at least 4, allows; a tile that is one hole has 8 edges.
AlphaOutline make_alpha_outline(
		const AlphaTest &p_test, uint32_t p_edge_budget, double p_tolerance_px = 0.125);

} // namespace gnomon
