#include "modules/scene/polygon_triangulation.h"

#include "modules/core/error.h"
#include "modules/scene/diagonal_flips.h"

#include <algorithm>
#include <set>

namespace gnomon {

namespace {

/// Whether p_a comes before p_b in the sweep, which goes from top to bottom, and from left to right
/// at equal heights.
bool is_above(const glm::ivec2 &p_a, const glm::ivec2 &p_b) {
	return p_a.y > p_b.y || (p_a.y == p_b.y && p_a.x < p_b.x);
}

/// Computes the result of triangulate.
class Triangulator {
public:
	explicit Triangulator(std::span<const PolygonLoop> p_loops);
	std::vector<uint32_t> run();

private:
	/// Edge i goes from point i to the next one of its loop. Edges in the sweep's status have the
	/// inside to their right and do not cross, so that left to right is a strict order.
	struct IsLeftOf {
		using is_transparent = void;
		const Triangulator &triangulator;
		bool operator()(uint32_t p_a, uint32_t p_b) const;
		bool operator()(uint32_t p_edge, const glm::ivec2 &p_point) const;
		bool operator()(const glm::ivec2 &p_point, uint32_t p_edge) const;
	};
	using Status = std::set<uint32_t, IsLeftOf>;

	const glm::ivec2 &get_upper(uint32_t p_edge) const;
	const glm::ivec2 &get_lower(uint32_t p_edge) const;
	bool split_into_monotone();
	void visit(uint32_t p_point);
	uint32_t find_left_edge(uint32_t p_point);
	void close_edge(uint32_t p_edge, uint32_t p_point);
	void open_edge(uint32_t p_point);
	/// Adds the diagonal from a point to the edge's helper if that is a merge point or p_always.
	void connect_helper(uint32_t p_edge, uint32_t p_point, bool p_always);
	void sort_outgoing(uint32_t p_point);
	uint32_t find_next(uint32_t p_from, uint32_t p_to) const;
	void triangulate_pieces();
	void triangulate_monotone(const std::vector<uint32_t> &p_corners);

	std::vector<glm::ivec2> points;
	std::vector<uint32_t> next, previous;
	std::vector<uint32_t> helpers;				 // per edge: its helper point (de Berg et al.)
	std::vector<uint8_t> is_merge;				 // per point: a merge vertex (de Berg et al.)
	std::vector<std::vector<uint32_t>> outgoing; // per point: points that edges lead to
	Status status{ IsLeftOf{ *this } };
	bool is_valid = true; // false: a loop has too few points, or loops cross or touch
	std::vector<uint32_t> triangles;
};

Triangulator::Triangulator(std::span<const PolygonLoop> p_loops) {
	for (const PolygonLoop &loop : p_loops) {
		const uint32_t first = static_cast<uint32_t>(points.size());
		const uint32_t count = static_cast<uint32_t>(loop.size());
		is_valid = is_valid && count >= 3;
		for (uint32_t i = 0; i < count; ++i) {
			GNOMON_ASSERT(std::abs(loop[i].x) <= MAX_POLYGON_COORDINATE &&
							std::abs(loop[i].y) <= MAX_POLYGON_COORDINATE,
					"point (", loop[i].x, ", ", loop[i].y, "), coordinates must be at most ",
					MAX_POLYGON_COORDINATE);
			points.push_back(loop[i]);
			next.push_back(first + (i + 1) % count);
			previous.push_back(first + (i + count - 1) % count);
		}
	}
	helpers.resize(points.size());
	is_merge.resize(points.size());
	outgoing.resize(points.size());
}

const glm::ivec2 &Triangulator::get_upper(uint32_t p_edge) const {
	const glm::ivec2 &a = points[p_edge];
	const glm::ivec2 &b = points[next[p_edge]];
	return is_above(a, b) ? a : b;
}

const glm::ivec2 &Triangulator::get_lower(uint32_t p_edge) const {
	const glm::ivec2 &a = points[p_edge];
	const glm::ivec2 &b = points[next[p_edge]];
	return is_above(a, b) ? b : a;
}

bool Triangulator::IsLeftOf::operator()(uint32_t p_edge, const glm::ivec2 &p_point) const {
	return compute_twice_signed_area(
				   triangulator.get_lower(p_edge), triangulator.get_upper(p_edge), p_point) < 0;
}

bool Triangulator::IsLeftOf::operator()(const glm::ivec2 &p_point, uint32_t p_edge) const {
	return compute_twice_signed_area(
				   triangulator.get_lower(p_edge), triangulator.get_upper(p_edge), p_point) > 0;
}

bool Triangulator::IsLeftOf::operator()(uint32_t p_a, uint32_t p_b) const {
	if (p_a == p_b) {
		return false;
	}
	const glm::ivec2 &upper_a = triangulator.get_upper(p_a);
	const glm::ivec2 &upper_b = triangulator.get_upper(p_b);
	if (upper_a == upper_b) {
		return (*this)(p_a, triangulator.get_lower(p_b));
	}
	// Tests the upper end of the edge that begins lower against the other edge.
	return is_above(upper_a, upper_b) ? (*this)(p_a, upper_b) : (*this)(upper_a, p_b);
}

std::vector<uint32_t> Triangulator::run() {
	if (!is_valid || !split_into_monotone()) {
		return {};
	}
	triangulate_pieces();
	// If loops cross or touch, triangles are reversed or do not add up to the loops' area.
	int64_t twice_area = 0;
	for (uint32_t point = 0; point < points.size(); ++point) {
		twice_area += compute_twice_signed_area(glm::ivec2(0), points[point], points[next[point]]);
	}
	for (size_t i = 0; i < triangles.size(); i += 3) {
		const int64_t signed_area = compute_twice_signed_area(
				points[triangles[i]], points[triangles[i + 1]], points[triangles[i + 2]]);
		is_valid = is_valid && signed_area >= 0;
		twice_area -= signed_area;
	}
	if (!is_valid || twice_area != 0) {
		return {};
	}
	shorten_diagonals(points, triangles);
	return std::move(triangles);
}

bool Triangulator::split_into_monotone() {
	std::vector<uint32_t> order(points.size());
	for (uint32_t point = 0; point < points.size(); ++point) {
		order[point] = point;
		outgoing[point].push_back(next[point]);
	}
	std::sort(order.begin(), order.end(),
			[&](uint32_t p_a, uint32_t p_b) { return is_above(points[p_a], points[p_b]); });
	for (const uint32_t point : order) {
		visit(point);
		if (!is_valid) {
			return false;
		}
	}
	return status.empty();
}

/// Handles a point of the sweep: de Berg et al., HANDLESTARTVERTEX to HANDLEREGULARVERTEX.
void Triangulator::visit(uint32_t p_point) {
	const glm::ivec2 &point = points[p_point];
	const glm::ivec2 &before = points[previous[p_point]];
	const glm::ivec2 &after = points[next[p_point]];
	const bool is_before_below = is_above(point, before);
	const bool is_after_below = is_above(point, after);
	const bool is_convex = compute_twice_signed_area(before, point, after) > 0;
	if (is_before_below && is_after_below) {
		if (!is_convex) { // split
			const uint32_t left = find_left_edge(p_point);
			if (!is_valid) {
				return;
			}
			connect_helper(left, p_point, /*p_always=*/true);
			helpers[left] = p_point;
		}
		open_edge(p_point);
	} else if (!is_before_below && !is_after_below) {
		close_edge(previous[p_point], p_point);
		if (!is_convex) { // merge
			is_merge[p_point] = 1;
			const uint32_t left = find_left_edge(p_point);
			if (!is_valid) {
				return;
			}
			connect_helper(left, p_point, /*p_always=*/false);
			helpers[left] = p_point;
		}
	} else if (is_after_below) { // the inside is to the right
		close_edge(previous[p_point], p_point);
		open_edge(p_point);
	} else {
		const uint32_t left = find_left_edge(p_point);
		if (!is_valid) {
			return;
		}
		connect_helper(left, p_point, /*p_always=*/false);
		helpers[left] = p_point;
	}
}

uint32_t Triangulator::find_left_edge(uint32_t p_point) {
	auto found = status.lower_bound(points[p_point]);
	if (found == status.begin()) {
		is_valid = false;
		return 0;
	}
	return *--found;
}

void Triangulator::close_edge(uint32_t p_edge, uint32_t p_point) {
	connect_helper(p_edge, p_point, /*p_always=*/false);
	is_valid = is_valid && status.erase(p_edge) == 1;
}

void Triangulator::open_edge(uint32_t p_point) {
	is_valid = is_valid && status.insert(p_point).second;
	helpers[p_point] = p_point;
}

void Triangulator::connect_helper(uint32_t p_edge, uint32_t p_point, bool p_always) {
	const uint32_t helper = helpers[p_edge];
	if (p_always || is_merge[helper]) {
		outgoing[p_point].push_back(helper);
		outgoing[helper].push_back(p_point);
	}
}

/// Sorts the outgoing edges of a point clockwise, from the direction to the previous point on.
void Triangulator::sort_outgoing(uint32_t p_point) {
	const glm::ivec2 origin = points[p_point];
	const glm::ivec2 start = points[previous[p_point]];
	const auto is_left = [&](uint32_t p_other) {
		return compute_twice_signed_area(origin, start, points[p_other]) > 0;
	};
	std::sort(outgoing[p_point].begin(), outgoing[p_point].end(), [&](uint32_t p_a, uint32_t p_b) {
		// Directions that are clockwise from the start by less than 180 degrees are to its right.
		if (is_left(p_a) != is_left(p_b)) {
			return is_left(p_b);
		}
		return compute_twice_signed_area(origin, points[p_a], points[p_b]) < 0;
	});
}

/// Returns the next corner of the piece to the left of an edge; p_to if there is none.
uint32_t Triangulator::find_next(uint32_t p_from, uint32_t p_to) const {
	const std::vector<uint32_t> &list = outgoing[p_to];
	if (previous[p_to] == p_from) {
		return list.front();
	}
	const auto found = std::find(list.begin(), list.end(), p_from);
	return found == list.end() || found + 1 == list.end() ? p_to : *(found + 1);
}

void Triangulator::triangulate_pieces() {
	for (uint32_t point = 0; point < points.size(); ++point) {
		sort_outgoing(point);
	}
	std::vector<std::vector<uint8_t>> is_visited(points.size());
	for (uint32_t point = 0; point < points.size(); ++point) {
		is_visited[point].resize(outgoing[point].size());
	}
	std::vector<uint32_t> corners;
	for (uint32_t point = 0; point < points.size(); ++point) {
		for (size_t i = 0; i < outgoing[point].size(); ++i) {
			if (is_visited[point][i]) {
				continue;
			}
			corners.clear();
			uint32_t from = point;
			uint32_t to = outgoing[point][i];
			size_t index = i;
			while (is_valid && !is_visited[from][index]) {
				is_visited[from][index] = 1;
				corners.push_back(from);
				const uint32_t next_corner = find_next(from, to);
				const auto found = std::find(outgoing[to].begin(), outgoing[to].end(), next_corner);
				is_valid = next_corner != to && found != outgoing[to].end();
				index = static_cast<size_t>(found - outgoing[to].begin());
				from = to;
				to = next_corner;
			}
			if (!is_valid) {
				return;
			}
			triangulate_monotone(corners);
		}
	}
}

/// Triangulates a monotone piece: de Berg et al., TRIANGULATEMONOTONEPOLYGON.
void Triangulator::triangulate_monotone(const std::vector<uint32_t> &p_corners) {
	const size_t count = p_corners.size();
	size_t top = 0;
	size_t bottom = 0;
	for (size_t i = 1; i < count; ++i) {
		top = is_above(points[p_corners[i]], points[p_corners[top]]) ? i : top;
		bottom = is_above(points[p_corners[bottom]], points[p_corners[i]]) ? i : bottom;
	}
	struct Corner {
		uint32_t point;
		bool is_left; // on the left chain: counterclockwise from the top down
	};
	std::vector<Corner> order;
	for (size_t i = 0; i < count; ++i) {
		const size_t steps = (i + count - top) % count;
		order.push_back({ p_corners[i], steps < (bottom + count - top) % count });
	}
	std::sort(order.begin(), order.end(), [&](const Corner &p_a, const Corner &p_b) {
		return is_above(points[p_a.point], points[p_b.point]);
	});
	const auto add = [&](uint32_t p_a, uint32_t p_b, uint32_t p_c) {
		triangles.insert(triangles.end(), { p_a, p_b, p_c });
	};
	std::vector<Corner> stack = { order[0], order[1] };
	for (size_t i = 2; i < count; ++i) {
		const Corner &corner = order[i];
		const bool is_last = i + 1 == count;
		if (is_last || corner.is_left != stack.back().is_left) {
			for (size_t k = 1; k < stack.size(); ++k) {
				// The stack has points of the other chain, from top to bottom.
				if (stack[k].is_left) {
					add(stack[k - 1].point, stack[k].point, corner.point);
				} else {
					add(stack[k].point, stack[k - 1].point, corner.point);
				}
			}
			stack = { order[i - 1], corner };
			continue;
		}
		Corner last = stack.back();
		stack.pop_back();
		while (!stack.empty()) {
			const glm::ivec2 &a = points[stack.back().point];
			const int64_t signed_area =
					compute_twice_signed_area(a, points[last.point], points[corner.point]);
			if (corner.is_left ? signed_area <= 0 : signed_area >= 0) {
				break;
			}
			if (corner.is_left) {
				add(stack.back().point, last.point, corner.point);
			} else {
				add(last.point, stack.back().point, corner.point);
			}
			last = stack.back();
			stack.pop_back();
		}
		stack.push_back(last);
		stack.push_back(corner);
	}
}

} // namespace

int64_t compute_twice_signed_area(
		const glm::ivec2 &p_a, const glm::ivec2 &p_b, const glm::ivec2 &p_c) {
	const int64_t ab_x = int64_t(p_b.x) - p_a.x;
	const int64_t ab_y = int64_t(p_b.y) - p_a.y;
	const int64_t ac_x = int64_t(p_c.x) - p_a.x;
	const int64_t ac_y = int64_t(p_c.y) - p_a.y;
	return ab_x * ac_y - ab_y * ac_x;
}

std::vector<uint32_t> triangulate(std::span<const PolygonLoop> p_loops) {
	return Triangulator(p_loops).run();
}

} // namespace gnomon
