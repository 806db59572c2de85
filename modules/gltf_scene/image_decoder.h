#pragma once

#include "modules/core/limits.h"
#include "modules/scene/texture.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace gnomon {

/// Limit on the texels of one image (256 MiB decoded). Each side is limited by MAX_IMAGE_SIZE_PX.
const uint64_t MAX_IMAGE_TEXELS = uint64_t(1) << 26;

/// Decodes a PNG or JPEG file to 8-bit RGBA. The first bytes determine the format. 16-bit channels
/// are reduced to their upper 8 bits, palettes and grey are expanded to RGB, and colour space
/// information is ignored (glTF 2.0, 3.8.3). Throws an Error for a damaged file, another format or
/// an image above the limits. The message states the problem and the next step, but not the file's
/// name. r_warning: receives a message in the same form if only part of a JPEG image or only the
/// first frame of an animated PNG was read; otherwise unchanged.
std::shared_ptr<const Image> decode_image(
		std::span<const uint8_t> p_bytes, std::string p_name, std::string &r_warning);

} // namespace gnomon
