#include "modules/error_report/mask_source.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

bool sees_whole_disc(const LightSnapshot &p_light, const glm::vec3 &p_light_position,
		const glm::vec3 &p_position, const glm::vec3 &p_normal) {
	const bool is_directional = p_light.type == LightType::DIRECTIONAL;
	const glm::vec3 to_light = is_directional ? glm::vec3(-p_light.get_direction_world())
											  : p_light_position - p_position;
	const float distance = glm::length(to_light); // 1 for directional, whose radius is a tangent
	if (!(distance > 0.0f)) {
		return false;
	}
	// The disc is perpendicular to the way to its centre; its lowest point lies R sin below that.
	const float cosine = glm::dot(to_light, p_normal) / distance;
	const float sine = std::sqrt(std::max(0.0f, 1.0f - cosine * cosine));
	return cosine * distance >= p_light.get_disc_radius() * sine;
}

} // namespace gnomon
