#pragma once

#include <cstdint>

// Limits that several modules share.

namespace gnomon {

/// Of images, masks and frames, on each side.
inline constexpr uint32_t MAX_IMAGE_SIZE_PX = 16384;
/// Of an image, how many texels a side make a pixel.
inline constexpr uint32_t MAX_ANTIALIASING = 4;
/// Of lengths that a user sets: sizes of lights, widths of penumbrae, distances in materials.
inline constexpr double MAX_LENGTH_M = 1e4;
/// The range of such a length as a property has it, in centimetres.
inline constexpr const char *LENGTH_HINT = "0,10000,0.01";
/// What was not used for so many frames is freed: a camera or light that turns away often turns
/// back soon, and one that stays away holds no memory.
inline constexpr uint64_t MAX_UNUSED_FRAMES = 60;

} // namespace gnomon
