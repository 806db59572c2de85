#include "modules/scene/alpha_test.h"

#include "modules/core/files.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

const float BLEND_CUTOFF = 0.5f; // of surfaces that are blended

/// Maps a texture coordinate into 0..1.
double wrap(double p_coordinate, TextureWrap p_wrap) {
	switch (p_wrap) {
		case TextureWrap::CLAMP:
			return std::clamp(p_coordinate, 0.0, 1.0);
		case TextureWrap::REPEAT:
			return p_coordinate - std::floor(p_coordinate);
		case TextureWrap::MIRROR:
			break;
	}
	const double twice = p_coordinate / 2 - std::floor(p_coordinate / 2);
	return twice < 0.5 ? 2 * twice : 2 - 2 * twice;
}

} // namespace

AlphaTest make_alpha_test(const Material &p_material) {
	const Texture &texture = p_material.base_color_texture;
	return { texture.image.get(),
		p_material.alpha_mode == AlphaMode::BLEND ? BLEND_CUTOFF : p_material.alpha_cutoff,
		texture.wrap_u, texture.wrap_v, texture.is_magnified_nearest };
}

uint64_t compute_hash(const AlphaTest &p_test, uint64_t p_seed) {
	uint64_t hash = compute_value_hash(p_test.cutoff, p_seed);
	hash = compute_value_hash(p_test.wrap_u, hash);
	hash = compute_value_hash(p_test.wrap_v, hash);
	hash = compute_value_hash(p_test.is_nearest, hash);
	return compute_value_hash(p_test.image ? p_test.image->content_hash : 0, hash);
}

float sample_alpha(const AlphaTest &p_test, const glm::dvec2 &p_uv) {
	if (!std::isfinite(p_uv.x) || !std::isfinite(p_uv.y)) {
		return 0.0f;
	}
	const Image &image = *p_test.image;
	const glm::dvec2 position(wrap(p_uv.x, p_test.wrap_u) * image.size_px.x,
			wrap(p_uv.y, p_test.wrap_v) * image.size_px.y);
	if (p_test.is_nearest) {
		return image.get_texel(std::min(static_cast<uint32_t>(position.x), image.size_px.x - 1),
					   std::min(static_cast<uint32_t>(position.y), image.size_px.y - 1))[3] /
				255.0f;
	}
	const glm::dvec2 first = glm::floor(position - 0.5);
	const glm::dvec2 weight = position - 0.5 - first;
	double alpha = 0;
	for (const int y : { 0, 1 }) {
		for (const int x : { 0, 1 }) {
			const uint8_t *texel = image.get_texel(
					wrap_texel(static_cast<int64_t>(first.x) + x, image.size_px.x, p_test.wrap_u),
					wrap_texel(static_cast<int64_t>(first.y) + y, image.size_px.y, p_test.wrap_v));
			alpha += (x ? weight.x : 1 - weight.x) * (y ? weight.y : 1 - weight.y) * texel[3];
		}
	}
	return static_cast<float>(alpha / 255.0);
}

uint32_t wrap_texel(int64_t p_index, uint32_t p_count, TextureWrap p_wrap) {
	if (p_wrap == TextureWrap::REPEAT) {
		return static_cast<uint32_t>((p_index + p_count) % p_count);
	}
	return static_cast<uint32_t>(std::clamp<int64_t>(p_index, 0, p_count - 1));
}

} // namespace gnomon
