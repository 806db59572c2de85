#pragma once

#include <cstdint>

// Limits and constants that several modules share.

namespace gnomon {

/// Largest width and height of images, masks and frames, in pixels.
inline constexpr uint32_t MAX_IMAGE_SIZE_PX = 16384;
/// Largest supersampling factor of an image: samples per pixel along each axis.
inline constexpr uint32_t MAX_ANTIALIASING = 4;
/// A receiver is in a penumbra if it sees more and less than these fractions of the light.
inline constexpr float MIN_PENUMBRA_VISIBILITY = 0.002f;
inline constexpr float MAX_PENUMBRA_VISIBILITY = 0.998f;
inline constexpr double DEGREES_PER_RADIAN = 57.29577951308232;
/// Largest light size, penumbra width and material distance that a user may set, in metres.
inline constexpr double MAX_LENGTH_M = 1e4;
/// The range of light sizes and penumbra widths as a PropertyInfo::hint: minimum, maximum and step
/// (1 cm), in metres.
inline constexpr const char *LENGTH_HINT = "0,10000,0.01";
/// GPU resources of the render graph, the shadow system and the device inside Godot are freed when
/// they were not used for this many frames. The delay avoids recreating them when a camera or light
/// turns away for a short time.
inline constexpr uint64_t MAX_UNUSED_FRAMES = 60;

} // namespace gnomon
