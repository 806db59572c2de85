#include "modules/scene/material.h"

namespace gnomon {

const char *get_shading_model_name(ShadingModel p_model) {
	return p_model == ShadingModel::PHONG ? "phong" : "metallic_roughness";
}

glm::vec3 Material::compute_transmittance(float p_scale) const {
	if (!(transmission > 0.0f)) {
		return glm::vec3(0.0f);
	}
	// Metals transmit no light (KHR_materials_transmission).
	glm::vec3 transmittance = transmission * (1.0f - metallic) * base_color;
	if (thickness_m > 0.0f && attenuation_distance_m > 0.0f) {
		transmittance *= glm::pow(
				attenuation_color, glm::vec3(thickness_m * p_scale / attenuation_distance_m));
	}
	for (int axis = 0; axis < 3; ++axis) {
		transmittance[axis] = transmittance[axis] > 0.0f ? glm::min(transmittance[axis], 1.0f)
														 : 0.0f; // NaN gives 0
	}
	return transmittance;
}

} // namespace gnomon
