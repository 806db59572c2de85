#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_scene.h"

#include <tiny_gltf.h>

#include <optional>
#include <vector>

namespace gnomon {

/// The JSON objects that may hold a light's values. If several set the same value, the first in the
/// order given in doc/scene_files.md is used.
struct GltfLightSources {
	size_t light_index = 0;			// of KHR_lights_punctual's lights
	std::optional<GltfObject> area; // an element of EXT_lights_area's lights
	/// Index of the light's node; in files of older Blender exporters also that of its parent,
	/// whose extras hold the light's properties (find_blender_owner).
	std::vector<size_t> nodes;
};

/// Reads everything of the light except its name and transform. Returns false if the light's type
/// is unknown. An invalid property is reported and keeps its default.
bool read_light(const tinygltf::Model &p_model, const GltfLightSources &p_sources,
		const GltfLoadOptions &p_options, GltfMessages &r_messages, Light3D &r_light);

/// Writes the values that differ from p_before, the light as loaded (all values if it is null),
/// into a definition of KHR_lights_punctual. An unset property is also removed from the extras of
/// p_nodes; otherwise it would be read from there again. r_area: a disk light of EXT_lights_area
/// whose size is set as well, because it takes precedence over the extras; may be null.
void write_light(const Light3D &p_light, const LightSettings *p_before, tinygltf::Light &r_light,
		const std::vector<tinygltf::Node *> &p_nodes, tinygltf::Value *r_area);

} // namespace gnomon
