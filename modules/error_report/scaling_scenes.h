#pragma once

#include "modules/error_report/report.h"
#include "modules/scene/nodes.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace gnomon {

/// The extent to which a part of the report is measured.
enum class ReportExtent {
	NONE,
	/// Scaling: three points per curve that a software device draws in seconds, no expensive
	/// technique. Stability: the ends and the centre of each sweep, at 64 x 64 pixels.
	QUICK,
	FULL, // scaling: 2k to 1M triangles, 1 to 64 lights, 128 to 2048 pixels
};

/// One curve: a group of configurations and the values of its abscissa.
struct ScalingSeries {
	const char *group;
	std::vector<double> values;
};
const std::vector<ScalingSeries> &get_scaling_series(ReportExtent p_extent);

/// The parameters that the scaling curves vary, one at a time.
struct ScalingScene {
	uint32_t triangle_count = 30000; // 1000..2000000; met within 2 %
	uint32_t light_count = 1;		 // 1..1024
	double light_size_m = 0.4;		 // R

	bool operator==(const ScalingScene &) const = default;
};

/// The study's knot over its ground under its spot light, with the requested number of triangles.
/// Further lights of the same kind are on a circle around it, each aimed at the knot. Lights are
/// named "Light 1" and so on, the camera "Camera". S is 4 m.
std::unique_ptr<Scene> make_scaling_scene(const ScalingScene &p_description);

/// Caches the last value: the techniques of one configuration draw the same meshes, whose topology
/// is then built only once.
template <typename Key, typename Value> class LastValue {
public:
	template <typename Make> const Value &get(const Key &p_key, Make p_make) {
		if (key != p_key) {
			key.reset();
			value = {}; // before the next one takes memory
			value = p_make();
			key = p_key;
		}
		return value;
	}

private:
	std::optional<Key> key;
	Value value;
};

} // namespace gnomon
