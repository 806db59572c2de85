#pragma once

#include "modules/core/property.h"

#include <glm/glm.hpp>

namespace gnomon {

enum class LightType { OMNI, SPOT, DIRECTIONAL };
/// "omni", "spot", "directional".
const char *get_light_type_name(LightType p_type);

/// What a light is, beside its place: its node, its file and a frame's snapshot hold one.
struct LightSettings {
	LightType type = LightType::OMNI;
	glm::vec3 color = glm::vec3(1.0f); // linear
	float intensity = 1.0f;			   // cd (omni, spot) or lx (directional)
	float range_m = 0.0f;			   // 0 = unlimited
	float inner_cone_rad = 0.0f;	   // half angles, 0 <= inner < outer <= pi/2
	float outer_cone_rad = 0.785398163f;
	/// Size, widths, technique (see Light3D::get_property_list) and what techniques and filters
	/// declare. Only what was set, also what nobody in this build declares: unknown properties
	/// survive a save untouched.
	PropertyValues properties;

	bool operator==(const LightSettings &) const = default;
};

} // namespace gnomon
