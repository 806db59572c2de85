#pragma once

#include "modules/scene/nodes.h"

#include <cstdint>
#include <memory>

namespace gnomon {

/// What the scaling curves vary, one at a time.
struct ScalingScene {
	uint32_t triangle_count = 30000; // 1000..2000000; met within 2 %
	uint32_t light_count = 1;		 // 1..1024
	double light_size_m = 0.4;		 // R
};

/// The study's knot over its ground under its spot light, in as many triangles as asked for;
/// further lights of the same kind stand around on a circle, each aimed at the knot. Lights are
/// named "Light 1" and so on, the camera "Camera". S is 4 m.
std::unique_ptr<Scene> make_scaling_scene(const ScalingScene &p_description);

} // namespace gnomon
