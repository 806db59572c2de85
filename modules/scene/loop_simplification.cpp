#include "modules/scene/loop_simplification.h"

#include "modules/scene/line_moments.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

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

/// One loop, and which of its points are retained.
struct Chain {
	const PolygonLoop *loop;
	std::vector<uint8_t> is_retained; // per point

	const glm::ivec2 &get(uint32_t p_point) const { return (*loop)[p_point % loop->size()]; }
	/// Returns the point between two others that is farthest from the line between them; p_end is
	/// above p_begin and may be beyond the loop's end (it wraps around).
	uint32_t find_farthest(uint32_t p_begin, uint32_t p_end, double &r_distance) const;
	/// Returns the end, at most p_end, of a line from p_begin that is as long as possible with all
	/// points between within the tolerance.
	uint32_t find_line_end(uint32_t p_begin, uint32_t p_end, double p_tolerance) const;
	void retain(uint32_t p_point) { is_retained[p_point % loop->size()] = 1; }
	void simplify(uint32_t p_begin, uint32_t p_end, double p_tolerance);
};

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

/// Whether the point is on one of the rectangle's sides and its two neighbours are not both on that
/// side. Such points stay.
bool is_fixed(const Chain &p_chain, uint32_t p_point, const glm::ivec2 &p_size) {
	const uint32_t count = static_cast<uint32_t>(p_chain.loop->size());
	const glm::ivec2 &before = p_chain.get(p_point + count - 1);
	const glm::ivec2 &point = p_chain.get(p_point);
	const glm::ivec2 &after = p_chain.get(p_point + 1);
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

std::vector<uint32_t> find_fixed_points(const PolygonLoop &p_loop, const glm::ivec2 &p_size) {
	const Chain chain{ &p_loop, {} };
	std::vector<uint32_t> fixed;
	for (uint32_t point = 0; point < p_loop.size(); ++point) {
		if (is_fixed(chain, point, p_size)) {
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

/// Retains as few points of a loop as the tolerance allows. The number depends on where the first
/// line starts: of several starts that with the fewest points is chosen, and of all tolerances that
/// lead to this number a small one. Loops that retain more than MAX_POINTS points would gain little
/// by these searches.
Chain simplify_loop(const PolygonLoop &p_loop, double p_tolerance, const glm::ivec2 &p_size) {
	const uint32_t MAX_STARTS = 64;
	const double TOLERANCE_FACTOR = 0.93; // from one attempt to the next
	const int MAX_ATTEMPTS = 16;		  // down to 0.93^16 = 0.31 of the tolerance
	const int64_t MAX_POINTS = 64;
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

std::vector<uint32_t> list_retained_points(const Chain &p_chain) {
	std::vector<uint32_t> retained;
	for (uint32_t point = 0; point < p_chain.is_retained.size(); ++point) {
		if (p_chain.is_retained[point]) {
			retained.push_back(point);
		}
	}
	return retained;
}

/// Returns the point between two others where the lines fitted to both sides of it have the least
/// error, or p_point, the current one, if none is better or its chords leave the tolerance.
/// p_before < p_point < p_after, see Chain::find_farthest.
uint32_t find_best_corner(const Chain &p_chain, const LineMoments &p_moments, uint32_t p_before,
		uint32_t p_point, uint32_t p_after, double p_tolerance) {
	const double MIN_GAIN = 1e-9; // relative, above rounding
	const auto compute_error = [&](uint32_t p_corner) {
		return p_moments.fit(p_before, p_corner).square_error +
				p_moments.fit(p_corner, p_after).square_error;
	};
	uint32_t best = p_point;
	double best_error = compute_error(p_point) * (1 - MIN_GAIN);
	for (uint32_t corner = p_before + 1; corner < p_after; ++corner) {
		const double error = compute_error(corner);
		if (error < best_error) {
			best_error = error;
			best = corner;
		}
	}
	double distances[2];
	p_chain.find_farthest(p_before, best, distances[0]);
	p_chain.find_farthest(best, p_after, distances[1]);
	return std::max(distances[0], distances[1]) <= p_tolerance ? best : p_point;
}

/// Moves retained points, the corners, along the loop to where the lines between them fit it best.
/// Their number and fixed points remain.
void move_corners(double p_tolerance, const glm::ivec2 &p_size, Chain &r_chain) {
	const int MAX_ROUNDS = 8;
	// Chords may deviate more, because the fitted lines are nearer to the loop.
	const double CHORD_TOLERANCE_FACTOR = 1.25;
	const uint32_t count = static_cast<uint32_t>(r_chain.loop->size());
	const LineMoments moments(*r_chain.loop);
	std::vector<uint32_t> corners = list_retained_points(r_chain);
	bool has_moved = corners.size() >= 3;
	for (int round = 0; round < MAX_ROUNDS && has_moved; ++round) {
		has_moved = false;
		for (size_t i = 0; i < corners.size(); ++i) {
			if (is_fixed(r_chain, corners[i], p_size)) {
				continue;
			}
			const uint32_t before = corners[(i + corners.size() - 1) % corners.size()];
			const auto get_index = [&](uint32_t p_point) { // above `before`
				return p_point <= before ? p_point + count : p_point;
			};
			const uint32_t corner =
					find_best_corner(r_chain, moments, before, get_index(corners[i]),
							get_index(corners[(i + 1) % corners.size()]),
							p_tolerance * CHORD_TOLERANCE_FACTOR) %
					count;
			if (corner != corners[i]) {
				r_chain.is_retained[corners[i]] = 0;
				r_chain.retain(corner);
				corners[i] = corner;
				has_moved = true;
			}
		}
	}
}

struct Segment {
	uint32_t chain;
	uint32_t begin, end; // points; see Chain::find_farthest
	glm::ivec2 a, b;

	int32_t get_min_x() const { return std::min(a.x, b.x); }
	int32_t get_max_x() const { return std::max(a.x, b.x); }
};

std::vector<Segment> list_segments(const std::vector<Chain> &p_chains) {
	std::vector<Segment> segments;
	for (uint32_t index = 0; index < p_chains.size(); ++index) {
		const Chain &chain = p_chains[index];
		const uint32_t count = static_cast<uint32_t>(chain.loop->size());
		uint32_t first = 0;
		while (!chain.is_retained[first]) {
			++first;
		}
		uint32_t begin = first;
		for (uint32_t point = first + 1; point <= first + count; ++point) {
			if (chain.is_retained[point % count]) {
				segments.push_back({ index, begin, point, chain.get(begin), chain.get(point) });
				begin = point;
			}
		}
	}
	std::sort(segments.begin(), segments.end(), [](const Segment &p_one, const Segment &p_other) {
		return p_one.get_min_x() < p_other.get_min_x();
	});
	return segments;
}

int get_sign(int64_t p_number) {
	return p_number > 0 ? 1 : p_number < 0 ? -1 : 0;
}

bool is_between(const glm::ivec2 &p_point, const glm::ivec2 &p_a, const glm::ivec2 &p_b) {
	return glm::min(p_a.x, p_b.x) <= p_point.x && p_point.x <= glm::max(p_a.x, p_b.x) &&
			glm::min(p_a.y, p_b.y) <= p_point.y && p_point.y <= glm::max(p_a.y, p_b.y);
}

/// Whether two segments cross or touch, other than at the common endpoint of consecutive ones.
bool do_intersect(const Segment &p_one, const Segment &p_other) {
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

/// Calls the visitor for each pair of segments that meet, until it returns false.
template <typename Visitor>
void visit_intersections(const std::vector<Segment> &p_segments, const Visitor &p_visit) {
	for (size_t i = 0; i < p_segments.size(); ++i) {
		const int32_t end = p_segments[i].get_max_x();
		for (size_t k = i + 1; k < p_segments.size() && p_segments[k].get_min_x() <= end; ++k) {
			if (do_intersect(p_segments[i], p_segments[k]) &&
					!p_visit(p_segments[i], p_segments[k])) {
				return;
			}
		}
	}
}

/// Restores a point of each segment that meets another. Returns false if none was restored.
bool restore_intersecting(std::vector<Chain> &r_chains) {
	bool has_restored = false;
	const auto restore_point = [&](const Segment &p_segment) {
		double distance = 0;
		const uint32_t point =
				r_chains[p_segment.chain].find_farthest(p_segment.begin, p_segment.end, distance);
		if (point != p_segment.begin) {
			r_chains[p_segment.chain].retain(point);
			has_restored = true;
		}
	};
	visit_intersections(list_segments(r_chains), [&](const Segment &p_one, const Segment &p_other) {
		restore_point(p_one);
		restore_point(p_other);
		return true;
	});
	return has_restored;
}

bool is_on_border(const glm::ivec2 &p_point, const glm::ivec2 &p_size) {
	return p_point.x == 0 || p_point.y == 0 || p_point.x == p_size.x || p_point.y == p_size.y;
}

/// Moves a point by at most p_max_distance, unless it is on the rectangle's border, where it must
/// match the next tile.
glm::ivec2 move_point(const glm::ivec2 &p_point, const glm::dvec2 &p_shift, double p_max_distance,
		const glm::ivec2 &p_size) {
	const double length = glm::length(p_shift);
	const glm::dvec2 shift = p_shift * (length > p_max_distance ? p_max_distance / length : 1.0);
	return is_on_border(p_point, p_size)
			? p_point
			: glm::clamp(p_point + glm::ivec2(glm::round(shift)), glm::ivec2(1), p_size - 1);
}

/// Returns the normal to the right of a line, which points outwards.
glm::dvec2 find_normal(const glm::ivec2 &p_from, const glm::ivec2 &p_to) {
	const glm::dvec2 along(p_to - p_from);
	return glm::dvec2(along.y, -along.x) / std::max(glm::length(along), 1.0);
}

int64_t compute_twice_area(const PolygonLoop &p_loop) {
	int64_t area = 0;
	for (size_t i = 0; i < p_loop.size(); ++i) {
		area += compute_twice_signed_area(
				glm::ivec2(0), p_loop[i], p_loop[(i + 1) % p_loop.size()]);
	}
	return area;
}

/// Moves all edges by one distance, at most p_max_distance, so that the loop has the given area.
void restore_area(int64_t p_twice_area, double p_max_distance, const glm::ivec2 &p_size,
		PolygonLoop &r_loop) {
	const size_t count = r_loop.size();
	std::vector<glm::dvec2> directions(count); // moves both lines at a point outwards by 1
	double change = 0;						   // of the area, for a distance of 1
	const double MIN_SQUARE_SUM = 0.5;		   // below: a spike of less than 41 degrees
	for (size_t i = 0; i < count; ++i) {
		const glm::ivec2 &before = r_loop[(i + count - 1) % count];
		const glm::ivec2 &after = r_loop[(i + 1) % count];
		const glm::dvec2 sum = find_normal(before, r_loop[i]) + find_normal(r_loop[i], after);
		if (is_on_border(r_loop[i], p_size) || glm::dot(sum, sum) < MIN_SQUARE_SUM) {
			continue;
		}
		directions[i] = sum * 2.0 / glm::dot(sum, sum);
		change += 0.5 * glm::dot(directions[i], glm::dvec2(after.y - before.y, before.x - after.x));
	}
	const double missing = 0.5 * double(p_twice_area - compute_twice_area(r_loop));
	const double distance =
			change > 0 ? std::clamp(missing / change, -p_max_distance, p_max_distance) : 0.0;
	for (size_t i = 0; i < count; ++i) {
		r_loop[i] = move_point(r_loop[i], directions[i] * distance, p_max_distance, p_size);
	}
}

/// Returns the retained points of a chain, moved by at most twice p_tolerance to where the lines
/// fitted to the loop between them meet: chords alone would shrink round shapes. Points on the
/// rectangle's border stay; restore_area lets the other lines compensate.
PolygonLoop fit_lines(const Chain &p_chain, double p_tolerance, const glm::ivec2 &p_size) {
	const std::vector<uint32_t> retained = list_retained_points(p_chain);
	const size_t count = retained.size();
	const LineMoments moments(*p_chain.loop);
	std::vector<FittedLine> lines;
	for (size_t i = 0; i < count; ++i) {
		const bool wraps = i + 1 == count;
		const uint32_t offset = wraps ? static_cast<uint32_t>(p_chain.loop->size()) : 0;
		lines.push_back(moments.fit(retained[i], retained[(i + 1) % count] + offset));
	}
	PolygonLoop moved;
	for (size_t i = 0; i < count; ++i) {
		const FittedLine &before = lines[(i + count - 1) % count];
		const FittedLine &after = lines[i];
		const glm::dvec2 point(p_chain.get(retained[i]));
		const glm::dvec2 normal_before(before.direction.y, -before.direction.x);
		const glm::dvec2 normal_after(after.direction.y, -after.direction.x);
		const double offset_before = glm::dot(normal_before, before.centroid - point);
		const double offset_after = glm::dot(normal_after, after.centroid - point);
		glm::dvec2 shift = (normal_before * offset_before + normal_after * offset_after) * 0.5;
		const double cross = normal_before.x * normal_after.y - normal_before.y * normal_after.x;
		if (std::abs(cross) > 0.1) { // at least 6 degrees between the lines: where they meet
			shift = glm::dvec2(offset_before * normal_after.y - offset_after * normal_before.y,
							offset_after * normal_before.x - offset_before * normal_after.x) /
					cross;
		}
		moved.push_back(move_point(p_chain.get(retained[i]), shift, p_tolerance, p_size));
	}
	restore_area(compute_twice_area(*p_chain.loop), p_tolerance, p_size, moved);
	return moved;
}

bool has_intersection(const std::vector<PolygonLoop> &p_loops) {
	std::vector<Chain> chains;
	for (const PolygonLoop &loop : p_loops) {
		chains.push_back({ &loop, std::vector<uint8_t>(loop.size(), 1) });
	}
	bool has_found = false;
	visit_intersections(list_segments(chains), [&](const Segment &, const Segment &) {
		has_found = true;
		return false;
	});
	return has_found;
}

} // namespace

std::vector<PolygonLoop> simplify_loops(
		const std::vector<PolygonLoop> &p_loops, int32_t p_tolerance, const glm::ivec2 &p_size) {
	std::vector<Chain> chains;
	for (const PolygonLoop &loop : p_loops) {
		chains.push_back(simplify_loop(loop, p_tolerance, p_size));
	}
	while (restore_intersecting(chains)) { // ends at the latest when all points are restored
	}
	std::vector<PolygonLoop> fitted;
	for (const Chain &chain : chains) {
		Chain moved = chain;
		move_corners(p_tolerance, p_size, moved);
		fitted.push_back(fit_lines(moved, p_tolerance, p_size));
	}
	if (!has_intersection(fitted)) {
		return fitted;
	}
	std::vector<PolygonLoop> simplified;
	for (const Chain &chain : chains) {
		PolygonLoop &loop = simplified.emplace_back();
		for (const uint32_t point : list_retained_points(chain)) {
			loop.push_back((*chain.loop)[point]);
		}
	}
	return simplified;
}

} // namespace gnomon
