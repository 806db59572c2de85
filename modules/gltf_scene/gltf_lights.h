#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_scene.h"

#include <tiny_gltf.h>

#include <optional>
#include <vector>

namespace gnomon {

/// Where one light's values are: the first object that has a value wins (doc/scene_files.md).
struct GltfLightSources {
	size_t light_index = 0;			// of KHR_lights_punctual's lights
	std::optional<GltfObject> area; // an element of EXT_lights_area's lights
	/// The node, and above it the object that Blender puts between a light and its parent.
	std::vector<size_t> nodes;
};

/// Fills all of the light but its name and transform. False when it is of an unknown type. A
/// refused property is reported and its default stays.
bool read_light(const tinygltf::Model &p_model, const GltfLightSources &p_sources,
		const GltfLoadOptions &p_options, GltfMessages &r_messages, Light3D &r_light);

/// Writes what differs from p_before (all, when null) into a definition of KHR_lights_punctual. A
/// property that was unset vanishes from p_nodes' extras too, else it would come back from there.
/// r_area: a disc of EXT_lights_area that gets the light's size, as it outranks the extras; or
/// null.
void write_light(const Light3D &p_light, const LightSettings *p_before, tinygltf::Light &r_light,
		const std::vector<tinygltf::Node *> &p_nodes, tinygltf::Value *r_area);

} // namespace gnomon
