#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_scene.h"

#include <optional>
#include <vector>

namespace gnomon {

/// The JSON objects that may hold a light's values. If several set the same value, the first in the
/// order given in doc/scene_files.md is used.
struct GltfLightSources {
	GltfObject definition;			// an element of KHR_lights_punctual's lights
	std::optional<GltfObject> area; // an element of EXT_lights_area's lights
	/// The light's node; in files of older Blender exporters also its parent, whose extras hold the
	/// light's properties (find_blender_owner).
	std::vector<GltfObject> nodes;
};

/// Reads and checks the lights of KHR_lights_punctual, without their properties. An invalid value
/// is reported, and its default used; a light of unknown type is reported and null.
std::vector<std::optional<LightSettings>> read_light_definitions(const GltfObject &p_root);
/// Reads a light's properties. An invalid one is reported and keeps its default.
void read_light_properties(const GltfLightSources &p_sources, const GltfLoadOptions &p_options,
		PropertyValues &r_properties);

/// Writes the values that differ from p_before, the light as loaded (all values if it is null),
/// into a definition of KHR_lights_punctual. An unset property is also removed from the extras of
/// p_nodes; otherwise it would be read from there again. r_area: a disk light of EXT_lights_area
/// whose size is set as well, because it takes precedence over the extras; may be null.
void write_light(const Light3D &p_light, const LightSettings *p_before, Json &r_light,
		const std::vector<Json *> &p_nodes, Json *r_area);

} // namespace gnomon
