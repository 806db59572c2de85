#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

class SurfaceSpread;

/// Returns the number of sectors of the sampling disc of Wang and Xiao 2015 (section 1.2):
/// p_sample_count / 8, rounded, at least 1, because the disc has 8 rings at s = 0.5. 48 samples per
/// pixel give 6 sectors; 120 give 15, as in figure 4 of the paper.
uint32_t compute_sector_count(uint32_t p_sample_count);

/// Returns sample offsets around a receiver, in radii, of equal weight and distributed as the
/// spread: a group of 1 set, one of 4 and one of 16 sets, one after another, with p_sample_count
/// samples per set. The pixels of a block of 1, 2 x 2 or 4 x 4 each use one set of the group
/// (receiver_scatter_shared.h). Each set is stratified: sample i is in the i-th of p_sample_count
/// strata, which are equal fractions of the light, at i times the golden angle. Each group of n
/// sets is stratified as a whole: every stratum is split into n substrata, set k uses the k-th of
/// them in bit-reversed order, and is rotated by k / n of the circle.
std::vector<glm::vec2> make_scatter_samples(const SurfaceSpread &p_spread, uint32_t p_sample_count);

} // namespace gnomon
