#include "modules/scene/loop_fitting.h"

#include "modules/scene/line_moments.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

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
	std::vector<uint32_t> corners = r_chain.list_retained();
	bool has_moved = corners.size() >= 3;
	for (int round = 0; round < MAX_ROUNDS && has_moved; ++round) {
		has_moved = false;
		for (size_t i = 0; i < corners.size(); ++i) {
			if (r_chain.is_fixed(corners[i], p_size)) {
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
	// Steps, because the area is not linear in the distance; the last ones only change the
	// rounding.
	const PolygonLoop loop = r_loop;
	const auto compute_missing = [&](const PolygonLoop &p_loop) {
		return 0.5 * double(p_twice_area - compute_twice_area(p_loop));
	};
	double distance = 0;
	double missing = compute_missing(r_loop);
	while (change > 0) {
		distance = std::clamp(distance + missing / change, -p_max_distance, p_max_distance);
		PolygonLoop moved = loop;
		for (size_t i = 0; i < count; ++i) {
			moved[i] = move_point(loop[i], directions[i] * distance, p_max_distance, p_size);
		}
		const double still_missing = compute_missing(moved);
		if (std::abs(still_missing) >= std::abs(missing)) {
			break;
		}
		missing = still_missing;
		r_loop = std::move(moved);
	}
}

/// Returns the retained points of a chain, moved by at most twice p_tolerance to where the lines
/// fitted to the loop between them meet: chords alone would shrink round shapes. Points on the
/// rectangle's border stay; restore_area lets the other lines compensate.
PolygonLoop fit_lines(const Chain &p_chain, double p_tolerance, const glm::ivec2 &p_size) {
	const std::vector<uint32_t> retained = p_chain.list_retained();
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

} // namespace

PolygonLoop fit_loop(const Chain &p_chain, double p_tolerance, const glm::ivec2 &p_size) {
	Chain moved = p_chain;
	move_corners(p_tolerance, p_size, moved);
	return fit_lines(moved, p_tolerance, p_size);
}

int64_t compute_twice_area(const PolygonLoop &p_loop) {
	int64_t area = 0;
	for (size_t i = 0; i < p_loop.size(); ++i) {
		area += compute_twice_signed_area(
				glm::ivec2(0), p_loop[i], p_loop[(i + 1) % p_loop.size()]);
	}
	return area;
}

} // namespace gnomon
