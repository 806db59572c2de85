#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

/// Closed-form visibilities of a disc light, in double precision. They share no code with the
/// reference tracer, whose tests compare against them.
namespace gnomon::closed_form {

/// Fraction of the light's disc that is visible when everything behind a straight edge is hidden
/// (area of a circular segment). p_distance: signed distance from the disc's centre to the edge in
/// radii of the disc, positive while the centre is visible.
inline double compute_half_plane_visibility(double p_distance) {
	const double distance = std::clamp(p_distance, -1.0, 1.0);
	const double hidden = std::acos(distance) - distance * std::sqrt(1 - distance * distance);
	return 1 - hidden / std::numbers::pi;
}

/// Fraction of the light's disc that an occluding disc, parallel to it, leaves visible. p_radius,
/// p_distance: radius of the occluder and distance of its centre from the light's, both as
/// projected from the receiver onto the light's plane, in radii of the light. The occluded area is
/// a lens.
inline double compute_disc_visibility(double p_radius, double p_distance) {
	if (p_distance >= 1 + p_radius) {
		return 1;
	}
	if (p_distance <= std::abs(1 - p_radius)) {
		return p_radius >= 1 ? 0 : 1 - p_radius * p_radius;
	}
	const double d2 = p_distance * p_distance;
	const double r2 = p_radius * p_radius;
	const double light_angle = std::acos(std::clamp((d2 + 1 - r2) / (2 * p_distance), -1.0, 1.0));
	const double occluder_angle =
			std::acos(std::clamp((d2 + r2 - 1) / (2 * p_distance * p_radius), -1.0, 1.0));
	const double kite = 0.5 *
			std::sqrt(std::max(0.0,
					(1 + p_radius - p_distance) * (1 + p_distance - p_radius) *
							(p_radius + p_distance - 1) * (1 + p_radius + p_distance)));
	return 1 - (light_angle + r2 * occluder_angle - kite) / std::numbers::pi;
}

/// Visibility (0..1) from p_point of a disc light past an opaque half-plane. The light's disc has
/// its centre at p_light and radius p_radius, and is perpendicular to p_light - p_point. The edge
/// of the half-plane is the line p_edge_point + s * p_edge_direction. p_open_side points from the
/// edge to the side that is not hidden. The plane of the half-plane must lie between p_point and
/// the whole disc. Then the result is exact, because the plane through p_point and the edge cuts
/// the disc in a straight line. For a directional light, p_light is one unit from p_point, against
/// the light's direction, and p_radius is the tangent of half the light's angle.
inline double compute_edge_visibility(const glm::dvec3 &p_point, const glm::dvec3 &p_light,
		double p_radius, const glm::dvec3 &p_edge_point, const glm::dvec3 &p_edge_direction,
		const glm::dvec3 &p_open_side) {
	glm::dvec3 normal = glm::normalize(glm::cross(p_edge_direction, p_edge_point - p_point));
	normal *= glm::dot(normal, p_open_side) < 0 ? -1.0 : 1.0;
	const glm::dvec3 axis = glm::normalize(p_light - p_point);
	// Within the disc's plane the cut is farther from the centre, by 1 / the length of the normal's
	// part in that plane.
	const double length_in_disc = glm::length(normal - glm::dot(normal, axis) * axis);
	return compute_half_plane_visibility(
			glm::dot(normal, p_light - p_point) / length_in_disc / p_radius);
}

} // namespace gnomon::closed_form
