#pragma once

#include "modules/scene/polygon_triangulation.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace gnomon {

/// A side of one of several loops.
struct LoopSegment {
	uint32_t loop;	// index of the loop
	uint32_t point; // index of its first point
	glm::ivec2 a, b;

	int32_t get_min_x() const { return glm::min(a.x, b.x); }
	int32_t get_max_x() const { return glm::max(a.x, b.x); }
};

/// Lists all pairs of segments that cross or touch, other than at the common endpoint of
/// consecutive ones.
std::vector<std::pair<LoopSegment, LoopSegment>> find_intersections(
		const std::vector<PolygonLoop> &p_loops);

} // namespace gnomon
