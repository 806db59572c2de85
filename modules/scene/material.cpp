#include "modules/scene/material.h"

namespace gnomon {

const char *get_shading_model_name(ShadingModel p_model) {
	return p_model == ShadingModel::PHONG ? "phong" : "metallic_roughness";
}

glm::vec3 Material::compute_transmittance(float p_scale) const {
	if (!(transmission > 0.0f)) {
		return glm::vec3(0.0f);
	}
	glm::vec3 left = transmission * (1.0f - metallic) * base_color;
	if (thickness_m > 0.0f && attenuation_distance_m > 0.0f) {
		left *= glm::pow(
				attenuation_color, glm::vec3(thickness_m * p_scale / attenuation_distance_m));
	}
	for (int axis = 0; axis < 3; ++axis) {
		left[axis] =
				left[axis] > 0.0f ? glm::min(left[axis], 1.0f) : 0.0f; // also what is no number
	}
	return left;
}

} // namespace gnomon
