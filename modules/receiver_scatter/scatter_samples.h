#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

class SurfaceSpread;

/// Sectors of the source's disc at that many samples for s = 0.5, whose disc has 8 rings: 48 are
/// its 6 sectors, 120 the 15 of its figure 4 (Wang, Xiao 2015, section 1.2). At least 1.
uint32_t compute_sector_count(uint32_t p_sample_count);

/// Points of equal weight about a receiver, in radii, distributed as the spread: a group of 1, one
/// of 4 and one of 16 sets, one after another, of p_sample_count points each. A set is even by
/// itself: point i takes the i-th share of the light, golden angles apart. So is a group: its k-th
/// set takes the k-th part of every share, turned by a k-th of the circle.
std::vector<glm::vec2> make_scatter_samples(const SurfaceSpread &p_spread, uint32_t p_sample_count);

} // namespace gnomon
