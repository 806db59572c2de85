#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

/// Visibilities of a disc light that are known in closed form, in double. For the tests of the
/// reference and of every technique; independent of both.
namespace gnomon::closed_form {

/// Share of a unit disc that stays when everything beyond a straight edge is hidden. p_distance:
/// from the disc's centre to the edge in radii, positive while the centre is visible. (Circular
/// segment.)
inline double compute_half_plane_visibility(double p_distance) {
	const double distance = std::clamp(p_distance, -1.0, 1.0);
	const double hidden = std::acos(distance) - distance * std::sqrt(1 - distance * distance);
	return 1 - hidden / M_PI;
}

/// Share of a unit disc that stays when a disc of radius p_radius, its centre p_distance away, is
/// before it. Both in radii of the light. (Area of the lens.)
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
	const double hider_angle =
			std::acos(std::clamp((d2 + r2 - 1) / (2 * p_distance * p_radius), -1.0, 1.0));
	const double kite = 0.5 *
			std::sqrt(std::max(0.0,
					(1 + p_radius - p_distance) * (1 + p_distance - p_radius) *
							(p_radius + p_distance - 1) * (1 + p_radius + p_distance)));
	return 1 - (light_angle + r2 * hider_angle - kite) / M_PI;
}

/// Visibility of a disc of radius p_radius at p_light, perpendicular to p_light - p_point, behind a
/// half-plane with the edge p_edge_point + s p_edge_direction. Whatever is on the side of
/// p_open_side stays visible. Exact for any position: a plane through the point cuts the disc in a
/// straight line. A directional light: p_light one unit from the point against its direction.
inline double compute_edge_visibility(const glm::dvec3 &p_point, const glm::dvec3 &p_light,
		double p_radius, const glm::dvec3 &p_edge_point, const glm::dvec3 &p_edge_direction,
		const glm::dvec3 &p_open_side) {
	glm::dvec3 normal = glm::normalize(glm::cross(p_edge_direction, p_edge_point - p_point));
	normal *= glm::dot(normal, p_open_side) < 0 ? -1.0 : 1.0;
	const glm::dvec3 axis = glm::normalize(p_light - p_point);
	const double slope = glm::length(normal - glm::dot(normal, axis) * axis);
	return compute_half_plane_visibility(glm::dot(normal, p_light - p_point) / slope / p_radius);
}

} // namespace gnomon::closed_form
