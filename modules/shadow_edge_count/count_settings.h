#pragma once

#include "modules/shadows/shadow_technique.h"

#include "shadow_edge_count/shadow_edge_count_shared.h"

namespace gnomon {

constexpr double SIDE_TOLERANCE_SIZES = 2.5e-7; // maximum shift of a plane by rounding, in S
constexpr double SIDE_TOLERANCE_COSINE = 1e-6;	// the same for a directional light, as a cosine

/// Settings of the technique for one light, from its light properties.
struct CountSettings {
	uint32_t sample_count = 64;				// points of the light: 64 or 256
	uint32_t budget = EDGE_COUNT_NO_BUDGET; // maximum number of edges of one leaf
	double time_budget_ms = -1;				// see CountTimeBudget; below 0: none
	float interpolation = 0; // maximum motion of an edge's projection onto the disc, see
							 // CountLightConstants
	/// R: the mean of the light's two penumbra widths in metres, by default its radius.
	/// Directional: that mean divided by S, a tangent.
	double disc_radius = 0;

	bool has_budget() const { return budget != EDGE_COUNT_NO_BUDGET; }
	bool has_time_budget() const { return time_budget_ms >= 0; }
	/// Number of sets of 64 points: 1 or 4.
	uint32_t get_sample_set_count() const { return sample_count / EDGE_COUNT_SAMPLE_COUNT; }
};

/// Adds the technique's light properties.
void add_count_properties(PropertyList &r_list);
/// p_properties: all of the light's properties that add_count_properties adds, with their values.
CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties);

/// The light's constants that every pass reads. Image sizes and capacities stay 0. p_view: its
/// first view. p_disc_radius: as in CountSettings.
shader::CountLightConstants make_count_light_constants(
		const LightView &p_view, double p_disc_radius, double p_scene_size_m);

} // namespace gnomon
