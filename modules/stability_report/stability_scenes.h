#pragma once

#include "modules/scene/nodes.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// Name of the light in make_stability_scene.
inline constexpr const char *STABILITY_LIGHT_NAME = "Light";

/// Builds a generated scene: a ground, casters above it, one light and a camera. p_sweep: id of the
/// sweep (StabilitySweep::id), which decides what p_value changes. For an unknown id nothing is
/// changed.
std::unique_ptr<Scene> make_stability_scene(
		const std::string &p_sweep, LightType p_type, double p_value);

/// Returns the names of the hostile scenes. They are the points of the sweep "guards", whose values
/// are indices of this list.
std::vector<std::string> list_hostile_scene_names();

} // namespace gnomon
