#pragma once

#include "modules/shadows/shadow_technique.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

namespace gnomon {

/// The technique's properties of one light.
struct CountSettings {
	uint32_t sample_count = 64; // points of the light: 64 or 256
	uint32_t map_size_px = 256;
	uint32_t budget = EDGE_COUNT_NO_BUDGET; // edges of one block of pixels
	float interpolation = 0; // of how many R an edge may move between a block's receivers
	double disc_radius = 0;	 // R in metres; directional: a tangent

	bool has_budget() const { return budget != EDGE_COUNT_NO_BUDGET; }
	uint32_t get_turn_count() const { return sample_count / EDGE_COUNT_SAMPLE_COUNT; }
};

void add_count_properties(PropertyList &r_list);
CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties);

/// What of a light every pass over its views and pixels reads; sizes of the image and capacities
/// are left at 0. Views look from the light's centre (directional: along one axis), so that turning
/// the first one's axes makes the others.
shader::CountLightConstants make_count_light_constants(
		const std::vector<LightView> &p_views, double p_disc_radius, double p_scene_size_m);

} // namespace gnomon
