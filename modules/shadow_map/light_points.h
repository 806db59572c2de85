#pragma once

#include "modules/scene/scene_snapshot.h"

#include <vector>

namespace gnomon {

/// The light shrunk to one of p_count points that represent its area; p_index below p_count.
///
/// Spot: a Vogel disc of radius R across the axis. Omni: points in a ball with density
/// 1 / sqrt(R^2 - r^2), whose projection along any direction is the uniform disc of radius R that
/// this direction sees. Directional: directions within the cone of half light_angular_distance.
/// The cone of a moved spot is widened so that its view still holds the cone of the centre beyond
/// p_nearest_m from the light.
LightSnapshot make_light_point(
		const LightSnapshot &p_light, uint32_t p_index, uint32_t p_count, double p_nearest_m);

/// Distance from the light's centre to the nearest instance's box; 0 inside one.
double compute_nearest_distance_m(const LightSnapshot &p_light, const SceneSnapshot &p_scene);

} // namespace gnomon
