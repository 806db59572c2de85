#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace gnomon {

/// A line, and how well it fits a part of a loop.
struct FittedLine {
	glm::dvec2 centroid;	 // of that part, on the line
	glm::dvec2 direction;	 // unit, from the part's begin towards its end
	double square_error = 0; // integral of the squared distance from the line along the part
};

/// Fits lines to parts of a loop by least squares: the integral of the squared distance along the
/// part is minimal. Lengths are in units of the loop's points.
class LineMoments {
public:
	explicit LineMoments(const std::vector<glm::ivec2> &p_loop);

	/// Fits the part from one point to another. p_begin: index of a point. p_end: above p_begin, at
	/// most p_begin plus the number of points (the part wraps around).
	FittedLine fit(uint32_t p_begin, uint32_t p_end) const;

private:
	/// Integrals along the loop from its first point.
	struct Sum {
		double length = 0;
		glm::dvec2 first_moment = glm::dvec2(0.0); // of the position relative to the first point
		double xx = 0, xy = 0, yy = 0;			   // second moments of that position
	};
	const std::vector<glm::ivec2> &loop;
	std::vector<Sum> sums; // per point, for two rounds
};

} // namespace gnomon
