#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

// A texture's outline clipped to the triangles of a mesh, so that triangles that share an edge make
// the same points on it.

namespace gnomon {

using PositionBits = std::array<uint32_t, 3>;
/// -0 as 0.
PositionBits to_position_bits(const glm::vec3 &p_position);

/// An edge of the mesh in the order of its ends' positions: the same from both its triangles.
struct MeshSide {
	glm::dvec2 uv[2];
	glm::dvec3 position[2];
	bool is_turned = false; // against the triangle's own direction

	glm::vec3 get_position(double p_share) const {
		return glm::vec3(position[0] + (position[1] - position[0]) * p_share);
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
	/// Twice, in the texture's coordinates; negative: mirrored. 0 where it is so thin that rounding
	/// decides.
	double area = 0;

	void set_up();
	/// Else all of it shows one line of texels, or none.
	bool has_area() const { return std::isfinite(area) && area != 0; }
	/// Above 0 inside, for each of the sides.
	double compute_inside(int p_side, const glm::dvec2 &p_uv) const;
	glm::vec3 compute_position(const glm::dvec2 &p_uv) const;
};

/// A convex piece of an outline while it is clipped to a triangle. Each side remembers the line it
/// lies on, so that a point is computed from the same two lines wherever it occurs.
class ClippedPiece {
public:
	struct Point {
		glm::dvec2 uv = glm::dvec2(0.0);
		int corner = -1;  // of the triangle
		int side = -1;	  // of the triangle, on which it lies
		double share = 0; // along that side
	};

	ClippedPiece(const MeshTriangle &p_triangle, const std::array<glm::dvec2, 3> &p_uvs);
	const std::vector<Point> &get_points() const { return points; }
	glm::vec3 get_position(const Point &p_point) const;
	double compute_area() const;

private:
	struct Line {
		int side = -1; // of the triangle; else these two points of the outline, in order
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
