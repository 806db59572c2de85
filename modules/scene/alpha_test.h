#pragma once

#include "modules/scene/material.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace gnomon {

/// An alpha test of a texture, which decides at which points a surface exists. Tests with equal
/// members pass in the same region.
struct AlphaTest {
	const Image *image = nullptr;
	/// Alpha threshold, 0..1: the test passes where the texture's alpha is at least this.
	float cutoff = 0.5f;
	TextureWrap wrap_u = TextureWrap::REPEAT;
	TextureWrap wrap_v = TextureWrap::REPEAT;
	bool is_nearest = false; // false: the four nearest texels are interpolated
};

/// Makes the test for the material's base colour texture. Its cutoff is the material's (0.5 for
/// AlphaMode::BLEND), which applies to the product of the texture's alpha, the material's and that
/// of vertex colours: divide it by the latter two for a threshold of the texture's alpha. The image
/// is null if there is no texture.
AlphaTest make_alpha_test(const Material &p_material);
/// Hashes everything that affects the test, texels included; without an image, the other fields.
uint64_t compute_hash(const AlphaTest &p_test, uint64_t p_seed);

/// Samples alpha, 0..1, at a point of the image's first mip level. p_uv: 0..1 spans the image's
/// width and height; outside, the wrap mode applies. Returns 0 if a coordinate is not finite.
float sample_alpha(const AlphaTest &p_test, const glm::dvec2 &p_uv);

/// Returns the texel index that replaces one just outside the image; p_index: -1 .. p_count.
uint32_t wrap_texel(int64_t p_index, uint32_t p_count, TextureWrap p_wrap);

} // namespace gnomon
