#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// Sets of offsets on the unit disc: each a stratified grid of JITTERED_PCF_TAPS_PER_RING
/// directions by p_ring_count radii, every point jittered within its cell, warped to the disc by
/// (sqrt(v) cos 2 pi u, sqrt(v) sin 2 pi u), the outermost ring first. Two offsets in each vec4;
/// one set follows the other. The same for the same count on every machine.
std::vector<glm::vec4> build_jitter_offsets(uint32_t p_ring_count);

} // namespace gnomon
