#pragma once

#include "modules/scene/scene_snapshot.h"

#include <vector>

namespace gnomon {

/// Returns the light, moved to point p_index of the p_count points that sample its area
/// (directional: turned to that direction).
///
/// Spot: a Vogel disc of radius R perpendicular to the axis. Omni: points in the sphere of radius R
/// with density 1 / sqrt(R^2 - r^2), whose projection along any direction is the uniform disc of
/// radius R. Directional: directions within a cone whose half angle is half
/// light_angular_distance. The cone of a moved spot is widened so that its view still contains the
/// original cone from the distance max(p_nearest_m, R) along the axis on.
LightSnapshot make_light_point(
		const LightSnapshot &p_light, uint32_t p_index, uint32_t p_count, double p_nearest_m);

/// Distance in metres from the light's centre to the nearest instance's box; 0 inside a box, 1e30
/// without instances.
double compute_nearest_distance_m(const LightSnapshot &p_light, const SceneSnapshot &p_scene);

} // namespace gnomon
