#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

// Clips a texture's outline to the triangles of a mesh, or to pairs of them. Neighbours with a
// common edge compute the same points on it.

namespace gnomon {

using PositionBits = std::array<uint32_t, 3>;
/// Returns the position's bits, with -0 as 0.
PositionBits to_position_bits(const glm::vec3 &p_position);

/// An edge of a polygon, its ends ordered by position, so that both polygons at the edge have the
/// same one.
struct MeshSide {
	glm::dvec2 uv[2];
	glm::dvec3 position[2];
	bool is_reversed = false; // reversed relative to the polygon's winding

	glm::vec3 get_position(double p_fraction) const {
		return glm::vec3(position[0] + (position[1] - position[0]) * p_fraction);
	}
	std::pair<PositionBits, PositionBits> get_key() const {
		return { to_position_bits(glm::vec3(position[0])),
			to_position_bits(glm::vec3(position[1])) };
	}
};

/// A triangle of the mesh in the coordinates of its texture, or two with a common edge that are one
/// convex quadrilateral with one affine map from texture coordinates to positions.
struct MeshPolygon {
	int corner_count = 3; // or 4
	glm::dvec2 uv[4];
	glm::vec3 position[4];
	MeshSide sides[4]; // from corner i to i + 1
	/// Twice the signed area in texture coordinates; negative: mirrored. 0 if a triangle is so thin
	/// that rounding decides.
	double area = 0;

	/// Computes sides and area from uv and position.
	void set_up();
	/// False: the texture coordinates are on one line, or not finite.
	bool has_area() const { return std::isfinite(area) && area != 0; }
	int get_next(int p_corner) const { return (p_corner + 1) % corner_count; }
	int get_previous(int p_corner) const { return (p_corner + corner_count - 1) % corner_count; }
	/// Returns the least and the greatest coordinates.
	std::pair<glm::dvec2, glm::dvec2> find_uv_bounds() const;
	/// Joins two triangles. False, and unchanged, if they are no quadrilateral as described above,
	/// apart from the rounding of positions to float.
	bool join(const MeshPolygon &p_other);
	/// Returns twice the signed area of the triangle of a side and the point: the distance from the
	/// side times its length. Above 0 inside.
	double compute_side_area(int p_side, const glm::dvec2 &p_uv) const;
	glm::dvec3 compute_position(const glm::dvec2 &p_uv) const;

private:
	double compute_corner_area(int p_corner) const;
};

/// A convex piece of an outline that is clipped to a polygon of the mesh. For each edge of the
/// piece it stores the original line, so that a point is computed from the same two lines wherever
/// it occurs. "Side" means a side of the mesh's polygon.
class ClippedPiece {
public:
	struct Point {
		glm::dvec2 uv = glm::dvec2(0.0);
		int corner = -1;	 // corner index of the polygon, or -1
		int side = -1;		 // side of the polygon on which the point lies, or -1
		double fraction = 0; // position along that side; while clipping it may be outside 0..1
	};

	/// Clips a triangle of the outline to the polygon, which must have an area and outlive the
	/// piece. No points: nothing is left.
	ClippedPiece(const MeshPolygon &p_polygon, const std::array<glm::dvec2, 3> &p_uvs);
	const std::vector<Point> &get_points() const { return points; }
	glm::vec3 get_position(const Point &p_point) const;
	/// Returns twice the signed area in texture coordinates.
	double compute_area() const;

private:
	struct Line {
		int side = -1; // side of the polygon; -1: a line of the outline
		/// Two points of the line; their order does not depend on the winding.
		glm::dvec2 a = glm::dvec2(0.0), b = glm::dvec2(0.0);
	};

	void clip(int p_side);
	double locate(int p_side, Point &r_point) const;
	Point cross_line(int p_side, const Line &p_line) const;

	const MeshPolygon &polygon;
	std::vector<Point> points;
	std::vector<Line> lines; // from point i to the next
};

} // namespace gnomon
