#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_scene.h"

#include <tiny_gltf.h>

#include <optional>
#include <vector>

namespace gnomon {

/// The JSON objects that may hold one light's values; the first that has a value wins
/// (doc/scene_files.md).
struct GltfLightSources {
	size_t light_index = 0;			// of KHR_lights_punctual's lights
	std::optional<GltfObject> area; // an element of EXT_lights_area's lights
	/// The node, and above it the object that Blender puts between a light and its parent.
	std::vector<size_t> nodes;
};

/// Reads everything of the light except its name and transform. Returns false if the light's type
/// is unknown. An invalid property is reported and keeps its default.
bool read_light(const tinygltf::Model &p_model, const GltfLightSources &p_sources,
		const GltfLoadOptions &p_options, GltfMessages &r_messages, Light3D &r_light);

/// Writes what differs from p_before (everything, if null) into a definition of
/// KHR_lights_punctual. An unset property is also removed from p_nodes' extras; otherwise it would
/// be read from there again. r_area: a disc of EXT_lights_area that gets the light's size, because
/// it takes precedence over the extras; may be null.
void write_light(const Light3D &p_light, const LightSettings *p_before, tinygltf::Light &r_light,
		const std::vector<tinygltf::Node *> &p_nodes, tinygltf::Value *r_area);

} // namespace gnomon
