#pragma once

#include "modules/error_report/report.h"
#include "modules/scene/nodes.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace gnomon {

enum class ScalingExtent {
	NONE,
	QUICK, // three points a curve that a software device draws in seconds, no expensive technique
	FULL,  // 2k to 1M triangles, 1 to 64 lights, 128 to 2048 pixels
};

/// One curve: a group of configurations and the values of its abscissa.
struct ScalingSeries {
	const char *group;
	std::vector<double> values;
};
const std::vector<ScalingSeries> &get_scaling_series(ScalingExtent p_extent);

/// What the scaling curves vary, one at a time.
struct ScalingScene {
	uint32_t triangle_count = 30000; // 1000..2000000; met within 2 %
	uint32_t light_count = 1;		 // 1..1024
	double light_size_m = 0.4;		 // R

	bool operator==(const ScalingScene &) const = default;
};

/// The study's knot over its ground under its spot light, in as many triangles as asked for;
/// further lights of the same kind stand around on a circle, each aimed at the knot. Lights are
/// named "Light 1" and so on, the camera "Camera". S is 4 m.
std::unique_ptr<Scene> make_scaling_scene(const ScalingScene &p_description);

/// The last scene that was made: the techniques of one configuration draw the same meshes, whose
/// topology is then built once.
class ScalingSceneCache {
public:
	std::shared_ptr<const Scene> get(const ScalingScene &p_description) {
		if (!scene || description != p_description) {
			scene.reset(); // before the next one takes memory
			scene = make_scaling_scene(p_description);
			description = p_description;
		}
		return scene;
	}

private:
	ScalingScene description;
	std::shared_ptr<const Scene> scene;
};

} // namespace gnomon
