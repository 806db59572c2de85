#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// The texels of an image file. Immutable once shared; identified by `id`.
struct Image {
	std::string name;
	glm::uvec2 size_px = glm::uvec2(0);
	/// 8-bit red, green, blue and alpha, top row first. The material's texture slot decides whether
	/// they are sRGB colours or linear data; alpha is linear and not premultiplied.
	std::vector<uint8_t> texels;
	uint64_t id = 0;		   // unique in the process, see make_image
	uint64_t content_hash = 0; // of size and texels

	const uint8_t *get_texel(uint32_t p_x, uint32_t p_y) const {
		return texels.data() + 4 * (size_t(p_y) * size_px.x + p_x);
	}
};

/// Makes an image with a new id. p_texels: four bytes per texel and at least one texel; anything
/// else is a programming error.
std::shared_ptr<const Image> make_image(
		std::string p_name, glm::uvec2 p_size_px, std::vector<uint8_t> p_texels);

/// How coordinates beyond the image's edge are handled: its edge texels, repetition, or mirrored
/// repetition.
enum class TextureWrap { CLAMP, REPEAT, MIRROR };
/// How mip levels are used: only the first, the nearest, or two of them blended.
enum class MipFilter { NONE, NEAREST, LINEAR };

/// An image with its sampler state and coordinates. Without an image it has no effect.
struct Texture {
	std::shared_ptr<const Image> image;
	TextureWrap wrap_u = TextureWrap::REPEAT;
	TextureWrap wrap_v = TextureWrap::REPEAT;
	bool is_magnified_nearest = false; // false: neighbouring texels are interpolated
	bool is_minified_nearest = false;
	MipFilter mip_filter = MipFilter::LINEAR;
	uint32_t uv_set = 0; // 0 or 1: the mesh's texture coordinate set
	/// Transforms the mesh's coordinates to the image's: x along its rows, y down from the top,
	/// 0..1 over its width and height (KHR_texture_transform).
	glm::mat3x2 transform = glm::mat3x2(1, 0, 0, 1, 0, 0);

	bool operator==(const Texture &) const = default;
	glm::vec2 transform_uv(const glm::vec2 &p_uv) const {
		return transform * glm::vec3(p_uv, 1.0f);
	}
};

} // namespace gnomon
