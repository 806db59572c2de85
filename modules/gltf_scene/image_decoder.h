#pragma once

#include "modules/core/limits.h"
#include "modules/scene/texture.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace gnomon {

/// Limit on the texels of one image (256 MiB decoded). Its sides may be up to MAX_IMAGE_SIZE_PX.
const uint64_t MAX_IMAGE_TEXELS = uint64_t(1) << 26;

/// Decodes a PNG or JPEG file, recognised by its first bytes. Of 16-bit channels the upper 8 bits
/// are used, palettes and greys become colours, and colour space information is ignored (glTF 2.0,
/// 3.8.2). A damaged file, another format, or one beyond the limits is an Error that states what is
/// wrong and what to do, without the file's name. r_loss: a message in the same words if a JPEG
/// image is only partly readable, or if only the first frame of an animated PNG was read; otherwise
/// unchanged.
std::shared_ptr<const Image> decode_image(
		std::span<const uint8_t> p_bytes, std::string p_name, std::string &r_loss);

} // namespace gnomon
