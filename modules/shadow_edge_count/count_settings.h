#pragma once

#include "modules/renderer/shadow_technique.h"
#include "modules/shadow_edge_count/count_space.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

namespace gnomon {

constexpr uint32_t COUNT_DEFAULT_BUDGET = 8192;
constexpr uint32_t COUNT_MOST_BUDGET = 65536;

/// The technique's properties of one light.
struct CountSettings {
	uint32_t sample_count = 64; // points of the light: 64 or 256
	uint32_t map_size_px = 256;
	uint32_t layer_count = 0;				// solids per texel that the layer map counts; 0: all
	uint32_t budget = COUNT_DEFAULT_BUDGET; // edges of one block of pixels
	double disc_radius = 0;					// R in metres; directional: a tangent
};

void add_count_properties(PropertyList &r_list);
CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties);

CountSpace make_count_space(const LightView &p_view, double p_disc_radius, double p_scene_size_m);
shader::CountViewConstants make_count_view_constants(
		const LightView &p_view, const CountSpace &p_space, uint32_t p_index);

} // namespace gnomon
