#include "modules/scene/loop_simplification.h"

#include "modules/scene/loop_chain.h"
#include "modules/scene/loop_fitting.h"
#include "modules/scene/loop_intersections.h"
#include "modules/scene/loop_nesting.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace gnomon {

namespace {

// A loop that gains or loses more than this fraction of its area is simplified less. The shadow's
// bias is at most this fraction of the opaque share: below 0.002.
const double MAX_AREA_ERROR = 0.002;
// Area that rounded points add, per length of the loop: half a unit.
const double ROUNDED_AREA_PER_LENGTH = 0.5;
const double MIN_TOLERANCE = 1; // units; below, a loop retains all points

/// A loop, simplified with a tolerance of its own so that it keeps its area.
class SimplifiedLoop {
public:
	SimplifiedLoop(const PolygonLoop &p_loop, double p_tolerance, const glm::ivec2 &p_size);

	const PolygonLoop &get_source() const { return loop; }
	const PolygonLoop &get_points() const { return points; }
	PolygonLoop get_chords() const { return chain.get_retained_loop(); }
	/// Whether the points are moved from the loop's own to where they fit it best.
	bool is_fitted() const { return uses_fit; }
	/// Restores points of the loop: of each given chord (its index in get_chords, before the call)
	/// the one that is farthest from it. Returns false if none was restored.
	bool restore_points(const std::vector<uint32_t> &p_chords);
	/// Lists the chords (indices in get_chords) that have passed over a point: it was on one side
	/// of the loop, and is on the other side of the chord.
	std::vector<uint32_t> list_chords_past(const glm::ivec2 &p_point) const;
	/// Uses the next candidate: the chords without the fit if they have the area, otherwise half
	/// the tolerance, in the end the loop itself.
	void refine();

private:
	/// Whether points enclose the loop's area, on the same side: a tiny loop must not turn around.
	bool has_area(const PolygonLoop &p_points) const {
		const int64_t area = compute_twice_area(p_points);
		return (area > 0) == (twice_area > 0) && (area < 0) == (twice_area < 0) &&
				0.5 * double(std::abs(area - twice_area)) <= max_area_error;
	}
	void simplify();
	void update_points();

	const PolygonLoop &loop;
	double tolerance;
	glm::ivec2 size;
	int64_t twice_area;
	double max_area_error;
	bool uses_fit = true;
	Chain chain{};
	PolygonLoop points;
};

SimplifiedLoop::SimplifiedLoop(
		const PolygonLoop &p_loop, double p_tolerance, const glm::ivec2 &p_size) :
		loop(p_loop),
		tolerance(p_tolerance), size(p_size), twice_area(compute_twice_area(p_loop)) {
	double length = 0;
	for (size_t i = 0; i < loop.size(); ++i) {
		length += glm::length(glm::dvec2(loop[(i + 1) % loop.size()] - loop[i]));
	}
	max_area_error = std::max(
			MAX_AREA_ERROR * 0.5 * double(std::abs(twice_area)), ROUNDED_AREA_PER_LENGTH * length);
	simplify();
}

void SimplifiedLoop::simplify() {
	uses_fit = tolerance >= MIN_TOLERANCE;
	chain = uses_fit ? simplify_loop(loop, tolerance, size)
					 : Chain{ &loop, std::vector<uint8_t>(loop.size(), 1) };
	update_points();
}

void SimplifiedLoop::update_points() {
	points = uses_fit ? fit_loop(chain, tolerance, size) : get_chords();
	if (!has_area(points)) {
		refine();
	}
}

void SimplifiedLoop::refine() {
	if (uses_fit && has_area(get_chords())) {
		uses_fit = false;
		update_points();
	} else {
		tolerance /= 2;
		simplify();
	}
}

bool SimplifiedLoop::restore_points(const std::vector<uint32_t> &p_chords) {
	const std::vector<uint32_t> retained = chain.list_retained();
	bool has_restored = false;
	for (const uint32_t chord : p_chords) {
		const uint32_t begin = retained[chord];
		const uint32_t end = chord + 1 < retained.size()
				? retained[chord + 1]
				: retained[0] + static_cast<uint32_t>(loop.size());
		double distance = 0;
		const uint32_t farthest = chain.find_farthest(begin, end, distance);
		if (farthest != begin) {
			chain.retain(farthest);
			has_restored = true;
		}
	}
	if (has_restored) {
		update_points();
	}
	return has_restored;
}

std::vector<uint32_t> SimplifiedLoop::list_chords_past(const glm::ivec2 &p_point) const {
	const std::vector<uint32_t> retained = chain.list_retained();
	std::vector<uint32_t> chords;
	for (uint32_t chord = 0; chord < retained.size(); ++chord) {
		const uint32_t end = chord + 1 < retained.size()
				? retained[chord + 1]
				: retained[0] + static_cast<uint32_t>(loop.size());
		PolygonLoop passed; // bounded by the chord and the part of the loop that it replaces
		for (uint32_t point = retained[chord]; point <= end; ++point) {
			passed.push_back(chain.get(point));
		}
		if (compute_winding_number(passed, p_point) != 0) {
			chords.push_back(chord);
		}
	}
	return chords;
}

/// Restores points where chords meet. Returns false if none was restored.
bool restore_meeting_chords(std::vector<SimplifiedLoop> &r_loops) {
	std::vector<PolygonLoop> chords;
	for (const SimplifiedLoop &loop : r_loops) {
		chords.push_back(loop.get_chords());
	}
	std::vector<std::vector<uint32_t>> meeting(r_loops.size());
	for (const auto &[one, other] : find_intersections(chords)) {
		meeting[one.loop].push_back(one.point);
		meeting[other.loop].push_back(other.point);
	}
	bool has_restored = false;
	for (size_t i = 0; i < r_loops.size(); ++i) {
		has_restored = r_loops[i].restore_points(meeting[i]) || has_restored;
	}
	return has_restored;
}

/// Refines the loops whose fitted lines meet others. Returns false if there are none.
bool refine_meeting_loops(std::vector<SimplifiedLoop> &r_loops) {
	std::vector<PolygonLoop> fitted;
	for (const SimplifiedLoop &loop : r_loops) {
		fitted.push_back(loop.get_points());
	}
	std::vector<uint8_t> meets(r_loops.size());
	for (const auto &[one, other] : find_intersections(fitted)) {
		meets[one.loop] = meets[other.loop] = 1;
	}
	bool has_refined = false;
	for (size_t i = 0; i < r_loops.size(); ++i) {
		if (meets[i] && r_loops[i].is_fitted()) { // chords alone do not meet
			r_loops[i].refine();
			has_refined = true;
		}
	}
	return has_refined;
}

/// Loops whose lines do not meet may still have passed over each other: a small hole that is nearer
/// to its border than the tolerance ends up outside.
struct PassedLoop {
	uint32_t loop; // all of it was passed over
	uint32_t by;   // by lines of this loop
};

/// Lists the loops that are not within the same loops as before. p_nesting: of the sources, see
/// compute_nesting. p_lines: one loop for each of p_loops; they do not meet.
std::vector<PassedLoop> find_passed_loops(const std::vector<SimplifiedLoop> &p_loops,
		const std::vector<int> &p_nesting, const std::vector<PolygonLoop> &p_lines) {
	const std::vector<int> nesting = compute_nesting(p_lines);
	std::vector<PassedLoop> passed;
	for (uint32_t i = 0; i < p_lines.size(); ++i) {
		for (uint32_t k = 0; nesting[i] != p_nesting[i] && k < p_lines.size(); ++k) {
			if (k != i &&
					compute_winding_number(p_lines[k], p_lines[i].front()) !=
							compute_winding_number(
									p_loops[k].get_source(), p_loops[i].get_source().front())) {
				passed.push_back({ i, k });
			}
		}
	}
	return passed;
}

/// Restores points of chords that have passed over a loop. Returns false if none was restored.
bool restore_passed_loops(const std::vector<int> &p_nesting, std::vector<SimplifiedLoop> &r_loops) {
	std::vector<PolygonLoop> chords;
	for (const SimplifiedLoop &loop : r_loops) {
		chords.push_back(loop.get_chords());
	}
	bool has_restored = false;
	for (const PassedLoop &passed : find_passed_loops(r_loops, p_nesting, chords)) {
		SimplifiedLoop &by = r_loops[passed.by];
		// A chord's first point is one of the source.
		has_restored =
				by.restore_points(by.list_chords_past(chords[passed.loop].front())) || has_restored;
	}
	return has_restored;
}

/// Refines the loops whose fitted lines have passed over others. Returns false if there are none.
bool refine_passed_loops(const std::vector<int> &p_nesting, std::vector<SimplifiedLoop> &r_loops) {
	std::vector<PolygonLoop> fitted;
	for (const SimplifiedLoop &loop : r_loops) {
		fitted.push_back(loop.get_points());
	}
	std::vector<uint8_t> is_involved(r_loops.size());
	for (const PassedLoop &passed : find_passed_loops(r_loops, p_nesting, fitted)) {
		is_involved[passed.loop] = is_involved[passed.by] = 1;
	}
	bool has_refined = false;
	for (size_t i = 0; i < r_loops.size(); ++i) {
		if (is_involved[i] && r_loops[i].is_fitted()) { // chords alone pass over none
			r_loops[i].refine();
			has_refined = true;
		}
	}
	return has_refined;
}

} // namespace

std::vector<PolygonLoop> simplify_loops(
		const std::vector<PolygonLoop> &p_loops, int32_t p_tolerance, const glm::ivec2 &p_size) {
	std::vector<SimplifiedLoop> loops;
	loops.reserve(p_loops.size());
	for (const PolygonLoop &loop : p_loops) {
		loops.emplace_back(loop, p_tolerance, p_size);
	}
	const std::vector<int> nesting = compute_nesting(p_loops);
	do {
		// Ends at the latest when all points are restored.
		while (restore_meeting_chords(loops) || restore_passed_loops(nesting, loops)) {
		}
		// Ends at the latest when no loop is fitted.
	} while (refine_meeting_loops(loops) || refine_passed_loops(nesting, loops));
	std::vector<PolygonLoop> simplified;
	for (const SimplifiedLoop &loop : loops) {
		simplified.push_back(loop.get_points());
	}
	return simplified;
}

} // namespace gnomon
