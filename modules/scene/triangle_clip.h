#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

// Clips a texture's outline to the triangles of a mesh. Triangles with a common edge compute the
// same points on it.

namespace gnomon {

using PositionBits = std::array<uint32_t, 3>;
/// Returns the position's bits, with -0 as 0.
PositionBits to_position_bits(const glm::vec3 &p_position);

/// An edge of a triangle, its ends ordered by position, so that both triangles at the edge have the
/// same one.
struct MeshSide {
	glm::dvec2 uv[2];
	glm::dvec3 position[2];
	bool is_reversed = false; // reversed relative to the triangle's winding

	glm::vec3 get_position(double p_fraction) const {
		return glm::vec3(position[0] + (position[1] - position[0]) * p_fraction);
	}
	std::pair<PositionBits, PositionBits> get_key() const {
		return { to_position_bits(glm::vec3(position[0])),
			to_position_bits(glm::vec3(position[1])) };
	}
};

/// A triangle of the mesh in the coordinates of its texture.
struct MeshTriangle {
	glm::dvec2 uv[3];
	glm::vec3 position[3];
	MeshSide sides[3]; // from corner i to i + 1
	/// Twice the signed area in texture coordinates; negative: mirrored. 0 if the triangle is so
	/// thin that rounding decides.
	double area = 0;

	/// Computes sides and area from uv and position.
	void set_up();
	/// False: the whole triangle shows one line of texels, or none.
	bool has_area() const { return std::isfinite(area) && area != 0; }
	/// Returns twice the signed area of the triangle of a side and the point: the distance from the
	/// side times its length. Above 0 inside.
	double compute_side_area(int p_side, const glm::dvec2 &p_uv) const;
	glm::vec3 compute_position(const glm::dvec2 &p_uv) const;
};

/// A convex piece of an outline that is clipped to a triangle of the mesh. For each edge of the
/// piece it stores the original line, so that a point is computed from the same two lines wherever
/// it occurs. "Side" means a side of the mesh's triangle.
class ClippedPiece {
public:
	struct Point {
		glm::dvec2 uv = glm::dvec2(0.0);
		int corner = -1;	 // corner index of the triangle, or -1
		int side = -1;		 // side of the triangle on which the point lies, or -1
		double fraction = 0; // position along that side; while clipping it may be outside 0..1
	};

	ClippedPiece(const MeshTriangle &p_triangle, const std::array<glm::dvec2, 3> &p_uvs);
	const std::vector<Point> &get_points() const { return points; }
	glm::vec3 get_position(const Point &p_point) const;
	double compute_area() const;

private:
	struct Line {
		/// Side of the triangle; -1: the line runs through these two points of the outline, in
		/// order.
		int side = -1;
		glm::dvec2 a = glm::dvec2(0.0), b = glm::dvec2(0.0);
	};

	void clip(int p_side);
	double locate(int p_side, Point &r_point) const;
	Point cross_line(int p_side, const Line &p_line) const;

	const MeshTriangle &triangle;
	std::vector<Point> points;
	std::vector<Line> lines; // from point i to the next
};

} // namespace gnomon
