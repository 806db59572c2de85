#pragma once

#include "modules/scene/polygon_triangulation.h"

#include <cstdint>
#include <vector>

namespace gnomon {

/// A loop, and which of its points are retained when it is simplified. Points are numbered along
/// the loop; numbers from the loop's size on mean points of a second round.
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
	/// Retains p_end and, after p_begin, as few points before it as the tolerance allows.
	void simplify(uint32_t p_begin, uint32_t p_end, double p_tolerance);
	/// Whether the point is on one of the sides of the rectangle from (0, 0) to p_size and its two
	/// neighbours are not both on that side. Such points stay.
	bool is_fixed(uint32_t p_point, const glm::ivec2 &p_size) const;
	/// Lists the numbers of the retained points, ascending.
	std::vector<uint32_t> list_retained() const;
	/// Returns the loop of the retained points.
	PolygonLoop get_retained_loop() const;
};

/// Retains as few points of a loop as the tolerance allows, but three at least. The number depends
/// on where the first line starts: of several starts that with the fewest points is chosen, and of
/// all tolerances that lead to this number a small one. Loops that retain more than a few dozen
/// points would gain little by these searches.
Chain simplify_loop(const PolygonLoop &p_loop, double p_tolerance, const glm::ivec2 &p_size);

} // namespace gnomon
