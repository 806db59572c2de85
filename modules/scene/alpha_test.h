#pragma once

#include "modules/scene/material.h"

#include <glm/glm.hpp>

#include <cstdint>

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

/// Alpha at a point of an image, 0..1, as a sampler reads its first level. p_uv: 1 is the image's
/// width and height. Beyond the image as its wrapping defines; 0 where a coordinate is not finite.
float sample_alpha(const AlphaTest &p_test, const glm::dvec2 &p_uv);

/// The texel that replaces one beyond the image's edge; p_index: -1 .. p_count.
uint32_t wrap_texel(int64_t p_index, uint32_t p_count, TextureWrap p_wrap);

} // namespace gnomon
