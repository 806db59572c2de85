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
	/// Red, green, blue and alpha of 8 bits, rows from the top. What they mean, colours of sRGB or
	/// numbers, is up to the texture's slot in the material; alpha is linear and not multiplied
	/// in.
	std::vector<uint8_t> texels;
	uint64_t id = 0;		   // unique in the process, see make_image
	uint64_t content_hash = 0; // of size and texels

	const uint8_t *get_texel(uint32_t p_x, uint32_t p_y) const {
		return texels.data() + 4 * (size_t(p_y) * size_px.x + p_x);
	}
};

/// Four bytes a texel, at least one texel: else a programming error.
std::shared_ptr<const Image> make_image(
		std::string p_name, glm::uvec2 p_size_px, std::vector<uint8_t> p_texels);

/// What is beyond an image's edge: its edge, or the image again, as it is or mirrored.
enum class TextureWrap { CLAMP, REPEAT, MIRROR };
/// How levels of detail are used: the first alone, the nearest, or two of them blended.
enum class MipFilter { NONE, NEAREST, LINEAR };

/// An image on a surface. Without image it changes nothing.
struct Texture {
	std::shared_ptr<const Image> image;
	TextureWrap wrap_u = TextureWrap::REPEAT;
	TextureWrap wrap_v = TextureWrap::REPEAT;
	bool is_magnified_nearest = false; // else neighbouring texels are interpolated
	bool is_minified_nearest = false;
	MipFilter mip_filter = MipFilter::LINEAR;
	uint32_t uv_set = 0; // 0 or 1: which coordinates of the mesh
	/// Then moved to these of the image: x along its rows, y down from the top, 1 its width and
	/// height (KHR_texture_transform).
	glm::mat3x2 transform = glm::mat3x2(1, 0, 0, 1, 0, 0);

	bool operator==(const Texture &) const = default;
	glm::vec2 transform_uv(const glm::vec2 &p_uv) const {
		return transform * glm::vec3(p_uv, 1.0f);
	}
};

} // namespace gnomon
