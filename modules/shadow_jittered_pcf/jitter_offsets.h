#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// Builds JITTERED_PCF_SETS_PER_SIDE^2 (64) sets of tap offsets on the unit disc. A set is a
/// stratified grid of JITTERED_PCF_TAPS_PER_RING (8) directions u by p_ring_count squared radii v,
/// each point jittered within its cell, then mapped to (sqrt(v) cos 2 pi u, sqrt(v) sin 2 pi u),
/// the outermost ring first. The sets follow each other, with two offsets per vec4. The result
/// depends only on p_ring_count.
std::vector<glm::vec4> build_jitter_offsets(uint32_t p_ring_count);

} // namespace gnomon
