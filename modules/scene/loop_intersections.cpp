#include "modules/scene/loop_intersections.h"

#include <algorithm>

namespace gnomon {

namespace {

int get_sign(int64_t p_number) {
	return p_number > 0 ? 1 : p_number < 0 ? -1 : 0;
}

bool is_between(const glm::ivec2 &p_point, const glm::ivec2 &p_a, const glm::ivec2 &p_b) {
	return glm::min(p_a.x, p_b.x) <= p_point.x && p_point.x <= glm::max(p_a.x, p_b.x) &&
			glm::min(p_a.y, p_b.y) <= p_point.y && p_point.y <= glm::max(p_a.y, p_b.y);
}

/// Whether two segments cross or touch, other than at the common endpoint of consecutive ones.
bool do_intersect(const LoopSegment &p_one, const LoopSegment &p_other) {
	if (glm::max(p_one.a.y, p_one.b.y) < glm::min(p_other.a.y, p_other.b.y) ||
			glm::max(p_other.a.y, p_other.b.y) < glm::min(p_one.a.y, p_one.b.y)) {
		return false;
	}
	if (p_one.b == p_other.a || p_one.a == p_other.b) {
		const glm::ivec2 &common = p_one.b == p_other.a ? p_one.b : p_one.a;
		const glm::ivec2 &one = p_one.b == p_other.a ? p_one.a : p_one.b;
		const glm::ivec2 &other = p_one.b == p_other.a ? p_other.b : p_other.a;
		const glm::dvec2 along_one(one - common);
		const glm::dvec2 along_other(other - common);
		return compute_twice_signed_area(common, one, other) == 0 &&
				glm::dot(along_one, along_other) > 0;
	}
	const int a = get_sign(compute_twice_signed_area(p_one.a, p_one.b, p_other.a));
	const int b = get_sign(compute_twice_signed_area(p_one.a, p_one.b, p_other.b));
	const int c = get_sign(compute_twice_signed_area(p_other.a, p_other.b, p_one.a));
	const int d = get_sign(compute_twice_signed_area(p_other.a, p_other.b, p_one.b));
	if (a * b < 0 && c * d < 0) {
		return true;
	}
	return (a == 0 && is_between(p_other.a, p_one.a, p_one.b)) ||
			(b == 0 && is_between(p_other.b, p_one.a, p_one.b)) ||
			(c == 0 && is_between(p_one.a, p_other.a, p_other.b)) ||
			(d == 0 && is_between(p_one.b, p_other.a, p_other.b));
}

} // namespace

std::vector<std::pair<LoopSegment, LoopSegment>> find_intersections(
		const std::vector<PolygonLoop> &p_loops) {
	std::vector<LoopSegment> segments;
	for (uint32_t loop = 0; loop < p_loops.size(); ++loop) {
		const PolygonLoop &points = p_loops[loop];
		for (uint32_t point = 0; point < points.size(); ++point) {
			segments.push_back({ loop, point, points[point], points[(point + 1) % points.size()] });
		}
	}
	std::sort(segments.begin(), segments.end(),
			[](const LoopSegment &p_one, const LoopSegment &p_other) {
				return p_one.get_min_x() < p_other.get_min_x();
			});
	std::vector<std::pair<LoopSegment, LoopSegment>> intersections;
	for (size_t i = 0; i < segments.size(); ++i) {
		const int32_t end = segments[i].get_max_x();
		for (size_t k = i + 1; k < segments.size() && segments[k].get_min_x() <= end; ++k) {
			if (do_intersect(segments[i], segments[k])) {
				intersections.emplace_back(segments[i], segments[k]);
			}
		}
	}
	return intersections;
}

} // namespace gnomon
