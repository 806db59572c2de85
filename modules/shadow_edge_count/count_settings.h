#pragma once

#include "modules/shadows/shadow_technique.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

namespace gnomon {

/// The technique's properties of one light.
struct CountSettings {
	uint32_t sample_count = 64; // points of the light: 64 or 256
	uint32_t map_size_px = 256;
	uint32_t budget = EDGE_COUNT_NO_BUDGET; // maximum number of edges of one block of pixels
	float interpolation = 0; // maximum motion of an edge's image within a block, as a multiple of R
	double disc_radius = 0;	 // R in metres; directional: a tangent

	bool has_budget() const { return budget != EDGE_COUNT_NO_BUDGET; }
	uint32_t get_turn_count() const { return sample_count / EDGE_COUNT_SAMPLE_COUNT; }
};

void add_count_properties(PropertyList &r_list);
CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties);

/// The light's constants that every pass over its views and pixels reads; image sizes and
/// capacities are left at 0. All views look from the light's centre (directional: one
/// view), so they differ from the first only by a rotation.
shader::CountLightConstants make_count_light_constants(
		const std::vector<LightView> &p_views, double p_disc_radius, double p_scene_size_m);

} // namespace gnomon
