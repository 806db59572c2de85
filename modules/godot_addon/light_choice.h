#pragma once

#include "modules/godot_addon/detail_levels.h"
#include "modules/godot_addon/shadow_node.h"

#include <span>
#include <vector>

namespace gnomon {

/// Returns the fraction of the views, 0 to 1, that the light may reach: that of the sphere or, for
/// a directional light, 1. The largest of all views counts; a light behind all cameras has 0.
float compute_coverage(const godot::Light3D &p_light, std::span<const ViewDetail> p_views);

/// Moves the nodes whose lights are to have masks to the front, at most p_count: first those with a
/// size, then by coverage. A light that has a mask already keeps it if another one covers only a
/// little more.
void choose_lights(
		std::vector<ShadowNode *> &r_nodes, std::span<const ViewDetail> p_views, size_t p_count);

} // namespace gnomon
