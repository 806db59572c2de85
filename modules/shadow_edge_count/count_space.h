#pragma once

#include <glm/glm.hpp>

#include <algorithm>

namespace gnomon {

/// The space of one light view in which receivers count edges (doc/techniques/edge_count.md,
/// "Space"). r is a point of the view: x right, y down, z along the view, metres, the light's
/// centre at the origin. Warped, lines stay lines, and a point nearer to the light has a greater w.
struct CountSpace {
	bool is_directional = false;
	double disc_radius = 0; // R in metres; directional: the tangent of half the apparent diameter
	double near_m = 1e-3;	// what is nearer to the light's plane is cut off; not for directional
	/// Edges are cut off where z is less than this part of |x| or |y|: float32 tells no more where
	/// a line lies whose end is a million times farther away. Not for directional.
	double least_slope = 1e-3;
	double depth_far_m = 1;	  // directional: w = depth_far_m - z
	double depth_range_m = 1; // directional: D, of the view
	double scene_size_m = 1;  // S

	/// (x', y', w): x/z, y/z, 1/z; directional: x, y, depth_far_m - z.
	glm::dvec3 warp(const glm::dvec3 &p_r) const {
		return is_directional ? glm::dvec3(p_r.x, p_r.y, depth_far_m - p_r.z)
							  : glm::dvec3(p_r.x / p_r.z, p_r.y / p_r.z, 1.0 / p_r.z);
	}
	/// Least z at which an edge's point is kept.
	double get_least_z(const glm::dvec2 &p_xy) const {
		return std::max(near_m, least_slope * std::max(std::abs(p_xy.x), std::abs(p_xy.y)));
	}
	/// What a relative tolerance of w is a share of: w itself; directional, where w has no scale of
	/// its own, max(S, D/250), since a deep view would loosen it with D alone.
	double get_depth_scale(double p_w) const {
		return is_directional ? std::max(scene_size_m, depth_range_m / 250.0) : p_w;
	}
	/// Above 0 where the face n.r + d = 0 is turned to the light's centre. Spot, omni: metres;
	/// directional: a cosine.
	double get_light_side(const glm::dvec4 &p_plane) const {
		return is_directional ? -p_plane.z : p_plane.w;
	}
};

/// A receiver in that space.
struct CountReceiver {
	glm::dvec3 r = glm::dvec3(0.0);
	glm::dvec3 normal = glm::dvec3(0.0, 0.0, -1.0); // unit, of the face, in the view's axes
};

/// What a receiver sees of the light's disc: exact for the disc that faces it, see the page. Maps
/// an offset (A, d) = (q' - p', w_q - w_p) so that A / d is a point of the disc's plane, in metres
/// (directional: tangents), and lines stay lines.
class DiscProjection {
public:
	DiscProjection(const CountSpace &p_space, const glm::dvec3 &p_r) {
		const double rho = glm::length(p_r);
		if (!p_space.is_directional && rho > 0) {
			side = glm::dvec2(p_r);
			turn = 1.0 / (rho * (rho + p_r.z));
			depth_turn = 1.0 / (rho * rho);
		}
	}
	/// p_offset: (A, d); the result likewise.
	glm::dvec3 project(const glm::dvec3 &p_offset) const {
		const double along = glm::dot(glm::dvec2(p_offset), side);
		return glm::dvec3(
				glm::dvec2(p_offset) - side * (turn * along), p_offset.z - along * depth_turn);
	}

private:
	glm::dvec2 side = glm::dvec2(0.0); // r.xy
	double turn = 0;
	double depth_turn = 0;
};

inline double cross(const glm::dvec2 &p_a, const glm::dvec2 &p_b) {
	return p_a.x * p_b.y - p_a.y * p_b.x;
}

} // namespace gnomon
