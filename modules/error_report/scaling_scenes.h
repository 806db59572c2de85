#pragma once

#include "modules/error_report/report.h"
#include "modules/scene/nodes.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace gnomon {

/// How much of the scaling curves, or of a report part (ReportPart), is measured.
enum class ReportExtent {
	NONE,
	/// Scaling: three points per curve, cheap enough for a software device, without techniques that
	/// have expensive settings.
	QUICK,
	/// Scaling: 2000 to 1 million triangles, 1 to 64 lights, 128 to 2048 pixels, light radii of
	/// 0.02 to 2.4 m.
	FULL,
};
/// The names of the extents, in their order.
inline constexpr const char *EXTENT_NAMES[] = { "none", "quick", "full" };
/// Returns the extent with that name. A name that is not in EXTENT_NAMES is a programming error.
ReportExtent parse_extent(std::string_view p_name);

/// A scaling curve: run time against one quantity.
struct ScalingSeries {
	const char *group;			// see ReportConfiguration::group
	std::vector<double> values; // of the quantity, ascending
};
/// Returns the curves of that extent; none for NONE.
const std::vector<ScalingSeries> &get_scaling_series(ReportExtent p_extent);

/// The parameters that the scaling curves vary, one at a time.
struct ScalingScene {
	uint32_t triangle_count = 30000; // 1000..2000000; met within 2 %
	uint32_t light_count = 1;		 // 1..1024
	double light_size_m = 0.4;		 // radius R of each light

	bool operator==(const ScalingScene &) const = default;
};

/// Builds the benchmark scene torus_knot (doc/benchmarks.md), with the requested number of
/// triangles and lights: a knot above a ground, under spot lights. The lights are evenly spaced on
/// a horizontal circle and aimed at the same point below the knot. They are named "Light 1", "Light
/// 2", ..., the camera "Camera". The scene size S is 4 m.
std::unique_ptr<Scene> make_scaling_scene(const ScalingScene &p_description);

/// A cache with a single entry. The techniques of one configuration use the same scene in
/// succession, so that the topology of its meshes is built only once.
template <typename Key, typename Value> class LastValue {
public:
	/// Returns the value of the last call if that had the same key, else p_make().
	template <typename Make> const Value &get(const Key &p_key, Make p_make) {
		if (key != p_key) {
			key.reset();
			value = {}; // frees its memory before the next value is built
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
