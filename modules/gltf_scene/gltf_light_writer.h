#pragma once

#include "modules/gltf_scene/gltf_document.h"

#include <vector>

namespace gnomon {

/// The shortest decimal number that reads back as this float.
Json to_json_number(float p_value);
/// The object's `extras`, made an object if it was none.
Json &require_extras(Json &r_object);

/// Writes what differs from p_before (all, when null) into a definition of KHR_lights_punctual. A
/// property that was unset vanishes from p_nodes' extras too, else it would come back from there.
/// r_area: a disc of EXT_lights_area that gets the light's size, as it outranks the extras; or
/// null.
void write_light(const Light3D &p_light, const LightSettings *p_before, Json &r_light,
		const std::vector<Json *> &p_nodes, Json *r_area);

} // namespace gnomon
