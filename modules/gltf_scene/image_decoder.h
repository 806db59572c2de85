#pragma once

#include "modules/core/limits.h"
#include "modules/scene/texture.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace gnomon {

/// What decoding an image may fill: 256 MiB. Its sides may have MAX_IMAGE_SIZE_PX.
const uint64_t MAX_IMAGE_TEXELS = uint64_t(1) << 26;

/// Decodes a PNG or JPEG file; its first bytes decide which. Of 16 bits the upper 8 are taken,
/// palettes and greys become colours, and what it states about colour spaces is ignored
/// (glTF 2.0, 3.8.2). Damaged, of another kind or beyond the limits above: an Error that states
/// what it is and what to do, without the file's name. r_loss: of a JPEG image that can be read in
/// part, and of an animated PNG image, of which the first frame is read, in the same words; else
/// left alone.
std::shared_ptr<const Image> decode_image(
		std::span<const uint8_t> p_bytes, std::string p_name, std::string &r_loss);

} // namespace gnomon
