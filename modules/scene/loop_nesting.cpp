#include "modules/scene/loop_nesting.h"

#include <algorithm>

namespace gnomon {

namespace {

/// A side of a loop that crosses some horizontal line of integer height.
struct Side {
	uint32_t loop; // index of the loop
	glm::ivec2 a, b;

	int32_t get_min_y() const { return glm::min(a.y, b.y); }
	int32_t get_max_y() const { return glm::max(a.y, b.y); }
};

/// Returns what a side adds to the winding number around a point: +-1 if it crosses the line from
/// the point in the direction of x, else 0.
int get_crossing(const glm::ivec2 &p_a, const glm::ivec2 &p_b, const glm::ivec2 &p_point) {
	if ((p_a.y <= p_point.y) == (p_b.y <= p_point.y)) {
		return 0;
	}
	const int64_t signed_area = compute_twice_signed_area(p_a, p_b, p_point);
	if (p_a.y <= p_point.y) {
		return signed_area > 0 ? 1 : 0;
	}
	return signed_area < 0 ? -1 : 0;
}

} // namespace

int compute_winding_number(const PolygonLoop &p_loop, const glm::ivec2 &p_point) {
	int number = 0;
	for (size_t i = 0; i < p_loop.size(); ++i) {
		number += get_crossing(p_loop[i], p_loop[(i + 1) % p_loop.size()], p_point);
	}
	return number;
}

std::vector<int> compute_nesting(const std::vector<PolygonLoop> &p_loops) {
	std::vector<Side> sides;
	std::vector<uint32_t> order(p_loops.size()); // of the loops, by the height of their first point
	for (uint32_t loop = 0; loop < p_loops.size(); ++loop) {
		const PolygonLoop &points = p_loops[loop];
		order[loop] = loop;
		for (size_t i = 0; i < points.size(); ++i) {
			sides.push_back({ loop, points[i], points[(i + 1) % points.size()] });
		}
	}
	std::sort(sides.begin(), sides.end(), [](const Side &p_one, const Side &p_other) {
		return p_one.get_min_y() < p_other.get_min_y();
	});
	std::sort(order.begin(), order.end(), [&](uint32_t p_one, uint32_t p_other) {
		return p_loops[p_one].front().y < p_loops[p_other].front().y;
	});
	std::vector<int> nesting(p_loops.size());
	std::vector<Side> active; // sides that may cross the line at the current height
	size_t next = 0;
	for (const uint32_t loop : order) {
		const glm::ivec2 &point = p_loops[loop].front();
		for (; next < sides.size() && sides[next].get_min_y() <= point.y; ++next) {
			active.push_back(sides[next]);
		}
		std::erase_if(active, [&](const Side &p_side) { return p_side.get_max_y() <= point.y; });
		for (const Side &side : active) {
			nesting[loop] += side.loop != loop ? get_crossing(side.a, side.b, point) : 0;
		}
	}
	return nesting;
}

} // namespace gnomon
