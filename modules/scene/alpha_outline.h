#pragma once

#include "modules/scene/material.h"
#include "modules/scene/polygon_triangulation.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// Where a texture's alpha decides that a surface is there. Two of one region are equal.
struct AlphaTest {
	const Image *image = nullptr;
	/// Of the texel's alpha, 0..1: a surface is there where it is at least that.
	float cutoff = 0.5f;
	TextureWrap wrap_u = TextureWrap::REPEAT;
	TextureWrap wrap_v = TextureWrap::REPEAT;
	bool is_nearest = false; // else the four nearest texels are interpolated
};

/// Of its base colour texture, of whose alpha the material's own is a factor: the cutoff is that of
/// the product. Without texture the image is null.
AlphaTest make_alpha_test(const Material &p_material);
/// Of all that it tests, texels included; of a null image of the rest.
uint64_t compute_hash(const AlphaTest &p_test, uint64_t p_seed);

/// Alpha at a place of an image, 0..1, as a sampler reads its first level. p_uv: 1 is the image's
/// width and height. Beyond the image as its wrapping says; 0 where a coordinate is not finite.
float sample_alpha(const AlphaTest &p_test, const glm::dvec2 &p_uv);

/// The region of a texture where its alpha is at least a cutoff, in one tile: the square 0..1 of
/// its coordinates.
struct AlphaOutline {
	static constexpr int32_t UNITS_PER_TEXEL = 256;

	glm::ivec2 size = glm::ivec2(0); // of the tile in units
	std::vector<glm::ivec2> points;	 // in units, from the image's upper left corner
	std::vector<uint32_t>
			triangles;		 // three points each, all turned one way; none: nothing is there
	bool is_whole = false;	 // all of the tile is there
	uint32_t edge_count = 0; // of its border
	/// 0: the contour itself. Else its squares stand for blocks of so many texels a side.
	uint32_t block_size_px = 0;

	bool is_empty() const { return triangles.empty(); }
};

/// The contour by marching squares through texels' centres: crossings are interpolated, a saddle is
/// decided by the mean of its four; simplified without crossings to within p_tolerance_px, texels.
/// At the tile's border it is closed, at the same places on either side where the texture repeats.
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
