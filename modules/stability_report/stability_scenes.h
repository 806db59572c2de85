#pragma once

#include "modules/scene/nodes.h"

#include <memory>
#include <string>
#include <vector>

namespace gnomon {

inline constexpr const char *STABILITY_LIGHT_NAME = "Light";

/// A ground, casters above it, one light and a camera, with one thing about them extreme: the value
/// of that sweep. An unknown sweep has the scene that all start from.
std::unique_ptr<Scene> make_stability_scene(
		const std::string &p_sweep, LightType p_type, double p_value);

/// Of the sweep "guards", whose values are indices of this list.
std::vector<std::string> list_guard_names();

} // namespace gnomon
