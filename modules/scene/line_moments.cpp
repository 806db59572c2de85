#include "modules/scene/line_moments.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

LineMoments::LineMoments(const std::vector<glm::ivec2> &p_loop) : loop(p_loop), sums(1) {
	const size_t count = loop.size();
	for (size_t point = 0; point < 2 * count; ++point) {
		// Relative to the first point: with large coordinates, fit() would subtract nearly equal
		// moments.
		const glm::dvec2 from(loop[point % count] - loop[0]);
		const glm::dvec2 along(loop[(point + 1) % count] - loop[point % count]);
		const double length = glm::length(along);
		const glm::dvec2 middle = from + along * 0.5;
		Sum sum = sums.back();
		sum.length += length;
		sum.first_moment += length * middle;
		// A segment's second moment: that of its middle, and length^2 / 12 about it.
		sum.xx += length * (middle.x * middle.x + along.x * along.x / 12);
		sum.xy += length * (middle.x * middle.y + along.x * along.y / 12);
		sum.yy += length * (middle.y * middle.y + along.y * along.y / 12);
		sums.push_back(sum);
	}
}

FittedLine LineMoments::fit(uint32_t p_begin, uint32_t p_end) const {
	const size_t count = loop.size();
	const Sum &begin = sums[p_begin];
	const Sum &end = sums[p_end];
	const double length = std::max(end.length - begin.length, 1e-9);
	const glm::dvec2 mean = (end.first_moment - begin.first_moment) / length;
	const double xx = (end.xx - begin.xx) / length - mean.x * mean.x;
	const double xy = (end.xy - begin.xy) / length - mean.x * mean.y;
	const double yy = (end.yy - begin.yy) / length - mean.y * mean.y;
	// The axes of the covariance matrix: the line is the one with the larger variance along it.
	const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
	const double variance = (xx + yy) / 2 - std::hypot((xx - yy) / 2, xy); // across the line
	const glm::dvec2 chord(loop[p_end % count] - loop[p_begin % count]);
	FittedLine line;
	line.centroid = glm::dvec2(loop[0]) + mean;
	line.direction = glm::dvec2(std::cos(angle), std::sin(angle));
	if (glm::dot(line.direction, chord) < 0) {
		line.direction = -line.direction;
	}
	line.square_error = length * std::max(variance, 0.0);
	return line;
}

} // namespace gnomon
