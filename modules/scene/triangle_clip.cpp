#include "modules/scene/triangle_clip.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace gnomon {

namespace {

/// Smallest width of a triangle relative to its corners' coordinates: several thousand rounding
/// errors.
const double MIN_RELATIVE_WIDTH = 1e-12;

double cross(const glm::dvec2 &p_a, const glm::dvec2 &p_b) {
	return p_a.x * p_b.y - p_a.y * p_b.x;
}

/// Returns twice the signed area of the triangle: above 0 to the left of the line from a to b.
double compute_signed_area(
		const glm::dvec2 &p_a, const glm::dvec2 &p_b, const glm::dvec2 &p_point) {
	return cross(p_b - p_a, p_point - p_a);
}

} // namespace

PositionBits to_position_bits(const glm::vec3 &p_position) {
	return std::bit_cast<PositionBits>(p_position + 0.0f);
}

void MeshPolygon::set_up() {
	for (int i = 0; i < corner_count; ++i) {
		const int k = get_next(i);
		MeshSide &side = sides[i];
		side.is_reversed = to_position_bits(position[k]) < to_position_bits(position[i]);
		side.uv[0] = side.is_reversed ? uv[k] : uv[i];
		side.uv[1] = side.is_reversed ? uv[i] : uv[k];
		side.position[0] = side.is_reversed ? position[k] : position[i];
		side.position[1] = side.is_reversed ? position[i] : position[k];
	}
	area = compute_corner_area(0);
	if (corner_count == 4) {
		area += compute_corner_area(2);
		return;
	}
	double max_length = 0;
	double max_coordinate = 0;
	for (int i = 0; i < corner_count; ++i) {
		const MeshSide &side = sides[i];
		max_length = std::max(max_length, glm::length(side.uv[1] - side.uv[0]));
		max_coordinate = std::max({ max_coordinate, std::abs(side.uv[0].x), std::abs(side.uv[0].y),
				std::abs(side.uv[1].x), std::abs(side.uv[1].y) });
	}
	if (std::abs(area) < MIN_RELATIVE_WIDTH * max_length * max_coordinate) {
		area = 0;
	}
}

double MeshPolygon::compute_side_area(int p_side, const glm::dvec2 &p_uv) const {
	const MeshSide &side = sides[p_side];
	const double left = compute_signed_area(side.uv[0], side.uv[1], p_uv);
	return side.is_reversed != (area < 0) ? -left : left;
}

std::pair<glm::dvec2, glm::dvec2> MeshPolygon::find_uv_bounds() const {
	std::pair bounds(uv[0], uv[0]);
	for (int corner = 1; corner < corner_count; ++corner) {
		bounds.first = glm::min(bounds.first, uv[corner]);
		bounds.second = glm::max(bounds.second, uv[corner]);
	}
	return bounds;
}

/// Returns twice the signed area of the triangle of a corner and its neighbours.
double MeshPolygon::compute_corner_area(int p_corner) const {
	const glm::dvec2 &corner = uv[p_corner];
	return cross(uv[get_next(p_corner)] - corner, uv[get_previous(p_corner)] - corner);
}

glm::dvec3 MeshPolygon::compute_position(const glm::dvec2 &p_uv) const {
	const int next = get_next(0);
	const int previous = get_previous(0);
	const glm::dvec2 offset = p_uv - uv[0];
	const double corner_area = compute_corner_area(0);
	double b = cross(offset, uv[previous] - uv[0]) / corner_area;
	double c = cross(uv[next] - uv[0], offset) / corner_area;
	if (corner_count == 3) { // the point is inside, apart from rounding
		b = std::clamp(b, 0.0, 1.0);
		c = std::clamp(c, 0.0, 1.0 - b);
	}
	const glm::dvec3 origin(position[0]);
	return origin + (glm::dvec3(position[next]) - origin) * b +
			(glm::dvec3(position[previous]) - origin) * c;
}

bool MeshPolygon::join(const MeshPolygon &p_other) {
	const double ROUNDING = 2.4e-7;		 // of positions, relative to the largest coordinate: 2^-22
	const double MIN_CORNER_AREA = 1e-6; // of the whole area; below, the corner is nearly straight
	const auto is_equal = [&](int p_own, int p_others) {
		return uv[p_own] == p_other.uv[p_others] && position[p_own] == p_other.position[p_others];
	};
	for (int own = 0; own < 3; ++own) {
		for (int other = 0; other < 3; ++other) {
			if (!is_equal(own, p_other.get_next(other)) || !is_equal(get_next(own), other)) {
				continue;
			}
			// Corners in order: this triangle's own one, the start of the common edge, the other
			// triangle's own one, the end of the common edge.
			MeshPolygon joined;
			joined.corner_count = 4;
			const int first = get_previous(own);
			const int opposite = p_other.get_previous(other);
			for (const auto &[target, source] :
					{ std::pair(0, first), std::pair(1, own), std::pair(3, get_next(own)) }) {
				joined.uv[target] = uv[source];
				joined.position[target] = position[source];
			}
			joined.uv[2] = p_other.uv[opposite];
			joined.position[2] = p_other.position[opposite];
			joined.set_up();
			bool is_convex = true;
			double largest = 0;
			for (int corner = 0; corner < 4; ++corner) {
				is_convex = is_convex &&
						joined.compute_corner_area(corner) / joined.area > MIN_CORNER_AREA;
				const glm::dvec3 size = glm::abs(glm::dvec3(joined.position[corner]));
				largest = std::max({ largest, size.x, size.y, size.z });
			}
			const double error = glm::distance(
					joined.compute_position(joined.uv[2]), glm::dvec3(joined.position[2]));
			if (!is_convex || !(error <= ROUNDING * largest)) {
				return false;
			}
			*this = joined;
			return true;
		}
	}
	return false;
}

ClippedPiece::ClippedPiece(const MeshPolygon &p_polygon, const std::array<glm::dvec2, 3> &p_uvs) :
		polygon(p_polygon) {
	for (int i = 0; i < 3; ++i) {
		const glm::dvec2 &a = p_uvs[i];
		const glm::dvec2 &b = p_uvs[(i + 1) % 3];
		Point &point = points.emplace_back();
		point.uv = a;
		const bool is_reversed = std::tie(b.x, b.y) < std::tie(a.x, a.y);
		lines.push_back({ /*side=*/-1, is_reversed ? b : a, is_reversed ? a : b });
	}
	for (int side = 0; side < polygon.corner_count && !points.empty(); ++side) {
		clip(side);
	}
	const bool is_finite = std::all_of(points.begin(), points.end(),
			[](const Point &p_point) { return std::isfinite(p_point.uv.x + p_point.uv.y); });
	if (!is_finite) { // rounding made crossing lines parallel: the piece is negligible
		points.clear();
	}
	for (Point &point : points) {
		point.fraction = std::clamp(point.fraction, 0.0, 1.0);
	}
}

/// Returns a value above 0 inside of a side, and 0 on it; then it also sets the point's side or
/// corner.
double ClippedPiece::locate(int p_side, Point &r_point) const {
	if (r_point.side == p_side || r_point.corner == p_side ||
			r_point.corner == polygon.get_next(p_side)) {
		return 0;
	}
	const double inside = polygon.compute_side_area(p_side, r_point.uv);
	if (inside == 0 && r_point.corner < 0) {
		if (r_point.side >= 0) { // on two sides: their corner
			r_point.corner = r_point.side == polygon.get_next(p_side) ? r_point.side : p_side;
			r_point.side = -1;
		} else {
			const MeshSide &side = polygon.sides[p_side];
			const glm::dvec2 along = side.uv[1] - side.uv[0];
			r_point.side = p_side;
			r_point.fraction = glm::dot(r_point.uv - side.uv[0], along) / glm::dot(along, along);
		}
	}
	return inside;
}

/// Returns the intersection of a side with a line of the piece.
ClippedPiece::Point ClippedPiece::cross_line(int p_side, const Line &p_line) const {
	Point point;
	const bool is_next = p_line.side == polygon.get_next(p_side);
	const bool is_previous = p_line.side == polygon.get_previous(p_side);
	if (p_line.side >= 0 && (is_next || is_previous)) {
		point.corner = is_next ? p_line.side : p_side;
		point.uv = polygon.uv[point.corner];
		return point;
	}
	const MeshSide &side = polygon.sides[p_side];
	const glm::dvec2 along = side.uv[1] - side.uv[0];
	const glm::dvec2 across = p_line.b - p_line.a;
	point.side = p_side;
	// Not clamped to the side's ends, because other sides clip what is beyond them.
	point.fraction = cross(p_line.a - side.uv[0], across) / cross(along, across);
	point.uv = side.uv[0] + along * point.fraction;
	return point;
}

/// Clips against one side (Sutherland and Hodgman 1974).
void ClippedPiece::clip(int p_side) {
	const size_t count = points.size();
	std::vector<double> inside(count);
	for (size_t i = 0; i < count; ++i) {
		inside[i] = locate(p_side, points[i]);
	}
	if (std::all_of(inside.begin(), inside.end(), [](double p_inside) { return p_inside >= 0; })) {
		return;
	}
	std::vector<Point> clipped;
	std::vector<Line> clipped_lines;
	const auto add = [&](const Point &p_point, const Line &p_line) {
		clipped.push_back(p_point);
		clipped_lines.push_back(p_line);
	};
	const MeshSide &side = polygon.sides[p_side];
	const Line along_side{ p_side, side.uv[0], side.uv[1] };
	for (size_t i = 0; i < count; ++i) {
		const double next = inside[(i + 1) % count];
		if (inside[i] >= 0) {
			add(points[i], inside[i] == 0 && next < 0 ? along_side : lines[i]);
		}
		if (inside[i] > 0 && next < 0) {
			add(cross_line(p_side, lines[i]), along_side);
		} else if (inside[i] < 0 && next > 0) {
			add(cross_line(p_side, lines[i]), lines[i]);
		}
	}
	points = clipped.size() < 3 ? std::vector<Point>() : std::move(clipped);
	lines = std::move(clipped_lines);
}

glm::vec3 ClippedPiece::get_position(const Point &p_point) const {
	if (p_point.corner >= 0) {
		return polygon.position[p_point.corner];
	}
	return p_point.side >= 0 ? polygon.sides[p_point.side].get_position(p_point.fraction)
							 : glm::vec3(polygon.compute_position(p_point.uv));
}

double ClippedPiece::compute_area() const {
	double area = 0;
	for (size_t i = 1; i + 1 < points.size(); ++i) {
		area += cross(points[i].uv - points[0].uv, points[i + 1].uv - points[0].uv);
	}
	return area;
}

} // namespace gnomon
