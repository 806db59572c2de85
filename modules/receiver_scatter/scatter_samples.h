#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

class SurfaceSpread;

/// How many sectors the source's disc has with p_sample_count samples: samples / 8, rounded, as its
/// disc for scatter s = 0.5 has 8 rings. 48 samples give 6 sectors, 120 give the 15 of its figure 4
/// (Wang, Xiao 2015, section 1.2). At least 1.
uint32_t compute_sector_count(uint32_t p_sample_count);

/// Points of equal weight about a receiver, in radii, distributed as the spread: a group of 1, one
/// of 4 and one of 16 sets, one after another, of p_sample_count points each. A set is even by
/// itself: point i takes the i-th share of the light, golden angles apart. So is a group of n
/// sets: set k takes one of n parts of every share (k with its bits reversed) and is turned by k /
/// n of the circle.
std::vector<glm::vec2> make_scatter_samples(const SurfaceSpread &p_spread, uint32_t p_sample_count);

} // namespace gnomon
