#pragma once

#include "modules/scene/loop_chain.h"

namespace gnomon {

/// Returns the loop of a chain's retained points, moved to where the lines between them fit the
/// chain's loop best: first along the loop, then from it by at most twice p_tolerance, so that the
/// loop keeps its area as far as that allows. Chords alone would shrink round shapes. Points on the
/// border of the rectangle from (0, 0) to p_size stay, so that they match the next tile. The result
/// may cross itself and other loops.
PolygonLoop fit_loop(const Chain &p_chain, double p_tolerance, const glm::ivec2 &p_size);

/// Returns twice the area inside a loop, negative for a hole.
int64_t compute_twice_area(const PolygonLoop &p_loop);

} // namespace gnomon
