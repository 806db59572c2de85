#pragma once

#include <glm/glm.hpp>

namespace gnomon {

/// The light as the reference sees it. Lengths in metres, in the space of the triangles.
struct AreaLight {
	bool is_directional = false;
	glm::vec3 position = glm::vec3(0.0f); // L, the disc's centre; spot and omni
	/// The direction in which it shines. Directional: any length above 0; spot with a cone: unit.
	glm::vec3 direction = glm::vec3(0, -1, 0);
	/// 0..1e18. Spot and omni: R; the disc at L is perpendicular to L - P. Directional: the tangent
	/// of half the apparent diameter; the disc is at unit distance. 0: a hard shadow, one ray.
	float disc_radius = 0.0f;
	float range_m = 0.0f;	 // 0 = unlimited
	float cos_outer = -1.0f; // of the spot's outer half angle; -1: no cone

	/// True when the light reaches a surface with this position and normal, shadows aside. The same
	/// test as is_receiver in light_inc.glsl.
	bool reaches(const glm::vec3 &p_position, const glm::vec3 &p_normal) const;
};

/// The light's disc as seen from the start of rays. The vector to a point of the disc is
/// centre + x * basis_x + y * basis_y, for (x, y) on the unit disc. Rays end at `end` times this
/// vector.
struct DiscView {
	glm::vec3 origin = glm::vec3(0.0f);
	glm::vec3 centre = glm::vec3(0.0f);	 // relative to the origin
	glm::vec3 basis_x = glm::vec3(0.0f); // length: the disc's radius
	glm::vec3 basis_y = glm::vec3(0.0f);
	float end = 1.0f;

	glm::vec3 compute_ray(float p_x, float p_y) const {
		return centre + p_x * basis_x + p_y * basis_y;
	}
};

/// Computes the view of the light's disc from a point moved by p_offset_m along its normal. Returns
/// false when no rays are needed: r_visibility is then 0 if the moved point or the vector to the
/// light is not finite, and 1 if the moved point is exactly on the light.
bool find_disc_view(const AreaLight &p_light, const glm::vec3 &p_position,
		const glm::vec3 &p_normal, float p_offset_m, DiscView &r_view, float &r_visibility);

/// Computes two unit vectors perpendicular to a unit vector and to each other (Duff et al. 2017).
void find_basis(const glm::vec3 &p_normal, glm::vec3 &r_x, glm::vec3 &r_y);

} // namespace gnomon
