#include "modules/scene/loop_chain.h"

#include <algorithm>

namespace gnomon {

namespace {

/// Lines grow point by point up to this many points, then in steps that double until a trial fails,
/// then halve: each trial checks all points of the line, and a straight border of a large image has
/// thousands.
const uint32_t MAX_SINGLE_STEPS = 64;

double compute_distance(const glm::ivec2 &p_point, const glm::ivec2 &p_a, const glm::ivec2 &p_b) {
	const glm::dvec2 along(p_b - p_a);
	const glm::dvec2 offset(p_point - p_a);
	const double square_length = glm::dot(along, along);
	const double fraction =
			square_length > 0 ? std::clamp(glm::dot(offset, along) / square_length, 0.0, 1.0) : 0.0;
	return glm::length(offset - along * fraction);
}

std::vector<uint32_t> find_fixed_points(const PolygonLoop &p_loop, const glm::ivec2 &p_size) {
	const Chain chain{ &p_loop, {} };
	std::vector<uint32_t> fixed;
	for (uint32_t point = 0; point < p_loop.size(); ++point) {
		if (chain.is_fixed(point, p_size)) {
			fixed.push_back(point);
		}
	}
	return fixed;
}

/// Retains some points, in ascending order, and between them as few as the tolerance allows.
Chain thin_out(
		const PolygonLoop &p_loop, const std::vector<uint32_t> &p_retained, double p_tolerance) {
	const uint32_t count = static_cast<uint32_t>(p_loop.size());
	Chain chain{ &p_loop, std::vector<uint8_t>(count) };
	for (size_t i = 0; i < p_retained.size(); ++i) {
		const uint32_t end = i + 1 < p_retained.size() ? p_retained[i + 1] : p_retained[0] + count;
		chain.simplify(p_retained[i], end, p_tolerance);
	}
	return chain;
}

/// Retains a triangle of a loop of which fewer points would remain.
void retain_triangle(Chain &r_chain) {
	const uint32_t count = static_cast<uint32_t>(r_chain.loop->size());
	const auto found = std::find(r_chain.is_retained.begin(), r_chain.is_retained.end(), 1);
	const uint32_t first = static_cast<uint32_t>(found - r_chain.is_retained.begin());
	double distance = 0;
	const uint32_t second = r_chain.find_farthest(first, first + count, distance);
	double distances[2];
	const uint32_t third[] = {
		r_chain.find_farthest(first, second, distances[0]),
		r_chain.find_farthest(second, first + count, distances[1]),
	};
	r_chain.retain(second);
	r_chain.retain(third[distances[1] > distances[0] ? 1 : 0]);
}

} // namespace

uint32_t Chain::find_farthest(uint32_t p_begin, uint32_t p_end, double &r_distance) const {
	uint32_t farthest = p_begin;
	r_distance = -1;
	for (uint32_t point = p_begin + 1; point < p_end; ++point) {
		const double distance = compute_distance(get(point), get(p_begin), get(p_end));
		if (distance > r_distance) {
			r_distance = distance;
			farthest = point;
		}
	}
	return farthest;
}

uint32_t Chain::find_line_end(uint32_t p_begin, uint32_t p_end, double p_tolerance) const {
	uint32_t end = p_begin + 1;
	bool is_growing = true;
	for (uint32_t step = 1; step > 0 && end < p_end;) {
		const uint32_t tried = std::min(end + step, p_end);
		double distance = 0;
		find_farthest(p_begin, tried, distance);
		const bool fits = distance <= p_tolerance;
		end = fits ? tried : end;
		is_growing = is_growing && fits;
		if (!is_growing) {
			step /= 2;
		} else if (end - p_begin >= MAX_SINGLE_STEPS) {
			step *= 2;
		}
	}
	return end;
}

/// Greedily makes each line as long as possible, which gives about a quarter fewer lines than
/// splitting at the farthest point (Douglas and Peucker 1973).
void Chain::simplify(uint32_t p_begin, uint32_t p_end, double p_tolerance) {
	for (uint32_t begin = p_begin; begin < p_end;) {
		begin = find_line_end(begin, p_end, p_tolerance);
		retain(begin);
	}
}

bool Chain::is_fixed(uint32_t p_point, const glm::ivec2 &p_size) const {
	const uint32_t count = static_cast<uint32_t>(loop->size());
	const glm::ivec2 &before = get(p_point + count - 1);
	const glm::ivec2 &point = get(p_point);
	const glm::ivec2 &after = get(p_point + 1);
	const bool is_on_x = point.x == 0 || point.x == p_size.x;
	const bool is_on_y = point.y == 0 || point.y == p_size.y;
	if (is_on_x && before.x == point.x && after.x == point.x) {
		return false;
	}
	if (is_on_y && before.y == point.y && after.y == point.y) {
		return false;
	}
	return is_on_x || is_on_y;
}

std::vector<uint32_t> Chain::list_retained() const {
	std::vector<uint32_t> retained;
	for (uint32_t point = 0; point < is_retained.size(); ++point) {
		if (is_retained[point]) {
			retained.push_back(point);
		}
	}
	return retained;
}

PolygonLoop Chain::get_retained_loop() const {
	PolygonLoop retained;
	for (const uint32_t point : list_retained()) {
		retained.push_back(get(point));
	}
	return retained;
}

Chain simplify_loop(const PolygonLoop &p_loop, double p_tolerance, const glm::ivec2 &p_size) {
	const uint32_t MAX_STARTS = 64;
	const double TOLERANCE_FACTOR = 0.93; // from one attempt to the next
	const int MAX_ATTEMPTS = 16;		  // down to 0.93^16 = 0.31 of the tolerance
	const int64_t MAX_POINTS = 64;		  // above: no search
	const auto count_retained = [](const Chain &p_chain) {
		return std::count(p_chain.is_retained.begin(), p_chain.is_retained.end(), 1);
	};
	const std::vector<uint32_t> fixed = find_fixed_points(p_loop, p_size);
	std::vector<uint32_t> starts = fixed.empty() ? std::vector<uint32_t>{ 0 } : fixed;
	Chain best = thin_out(p_loop, starts, p_tolerance);
	if (fixed.empty() && count_retained(best) <= MAX_POINTS) {
		const uint32_t count = static_cast<uint32_t>(p_loop.size());
		const uint32_t line_end = std::min(best.find_line_end(0, count, p_tolerance), count - 1);
		const uint32_t step = (line_end + MAX_STARTS - 1) / MAX_STARTS;
		for (uint32_t start = step; start <= line_end; start += step) {
			Chain chain = thin_out(p_loop, { start }, p_tolerance);
			if (count_retained(chain) < count_retained(best)) {
				best = std::move(chain);
				starts = { start };
			}
		}
	}
	double tolerance = p_tolerance;
	for (int i = 0; i < MAX_ATTEMPTS && count_retained(best) <= MAX_POINTS; ++i) {
		tolerance *= TOLERANCE_FACTOR;
		Chain chain = thin_out(p_loop, starts, tolerance);
		if (count_retained(chain) > count_retained(best)) {
			break;
		}
		best = std::move(chain);
	}
	if (count_retained(best) < 3) { // too thin
		retain_triangle(best);
	}
	return best;
}

} // namespace gnomon
