#pragma once

#include "modules/shadow_reference/embree_scene.h"

#include <optional>
#include <span>
#include <vector>

namespace gnomon {

/// Triangles that leave a part of each ray that meets them, once or more often.
struct TranslucentTriangles {
	Triangles triangles;
	glm::vec3 transmittance = glm::vec3(0.0f); // 0..1
};

/// All that hides a light. See AreaLightVisibility for what is allowed.
class CasterScene {
public:
	CasterScene(std::span<const glm::vec3> p_positions,
			std::span<const uint32_t> p_triangle_indices,
			std::span<const TranslucentTriangles> p_translucent);

	bool is_colored() const { return translucent.has_value(); }
	/// What is left of each of eight rays, which start at one point; of those with valid = 0,
	/// nothing.
	void trace(const int *p_valid, RTCRay8 &r_rays, glm::vec3 *r_left) const;
	/// Of one ray.
	glm::vec3 trace(const glm::vec3 &p_origin, const glm::vec3 &p_ray, float p_end) const;

private:
	EmbreeScene opaque;
	std::optional<EmbreeScene> translucent; // a geometry for each body
	std::vector<glm::vec3> transmittances;	// of the bodies
};

} // namespace gnomon
