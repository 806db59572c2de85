#pragma once

#include "modules/gltf_scene/gltf_json.h"
#include "modules/gltf_scene/gltf_scene.h"

#include <optional>
#include <string_view>
#include <vector>

namespace gnomon {

/// Other names under which files hold a property of Light3D, in the order in which they are tried.
struct GltfPropertyAlias {
	std::string_view property;
	std::string_view alias;
	double factor; // property = alias times this
};
std::span<const GltfPropertyAlias> get_gltf_property_aliases();

/// Where one light's values stand: the first place that has a value wins (DESIGN, scene files).
struct GltfLightPlaces {
	size_t light_index = 0;
	GltfObject light;				// an element of KHR_lights_punctual's lights
	std::optional<GltfObject> area; // an element of EXT_lights_area's lights
	/// The node, and above it the object that Blender puts between a light and its parent.
	std::vector<GltfObject> nodes;
};

/// Fills all of the light but its name and transform. False when it is of an unknown type, which is
/// reported. A refused value is reported and its default stays.
bool read_light(
		const GltfLightPlaces &p_places, const GltfLoadOptions &p_options, Light3D &r_light);

} // namespace gnomon
