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
	/// Three indices of points each, all with the same winding; empty: alpha is below the cutoff
	/// everywhere.
	std::vector<uint32_t> triangles;
	bool covers_tile = false; // the region is the whole tile
	uint32_t edge_count = 0;  // edges of the region's border
	/// 0: the outline is the simplified contour. Above 0: it is a half-tone of squares, one for
	/// each block of this many texels a side.
	uint32_t block_size_px = 0;

	bool is_empty() const { return triangles.empty(); }
};

/// Finds the contour by marching squares through the texel centres: crossings are interpolated, a
/// saddle is resolved by the alpha where its asymptotes cross. The contour is simplified without
/// self-intersection with a tolerance of p_tolerance_px texels (simplify_loops). At the tile's
/// border it is closed, at the same points on opposite sides if the texture repeats. For a nearest
/// sampler the contour follows the texels' squares, simplified only if the tolerance is at least
/// half a texel.
///
/// An outline with more edges than p_edge_budget is simplified further, with a tolerance of up to
/// one texel. If it still has more edges, as noise has, it becomes a half-tone: each block of
/// texels gets a square, or a square hole, of the same area as the opaque part has there. The
/// blocks are as small as the budget (at least 4 edges) allows; a tile that is one block with a
/// hole has 8 edges.
AlphaOutline make_alpha_outline(
		const AlphaTest &p_test, uint32_t p_edge_budget, double p_tolerance_px = 0.125);

} // namespace gnomon
