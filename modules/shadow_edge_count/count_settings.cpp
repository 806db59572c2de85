#include "modules/shadow_edge_count/count_settings.h"

#include <algorithm>

namespace gnomon {

namespace {

/// An edge counts only if it is nearer to the light than the receiver by this fraction of the
/// receiver's distance to the light (directional: of max(S, D / 250), D the view's depth in
/// metres), or less in proportion to the distance by which the receiver is moved off its surface
/// (compute_receiver_offset_m). Closer edges are those of the receiver's own surface, or due to
/// rounding.
const double NEARER_TOLERANCE = 2e-5;
const double DEPTH_RANGE_DIVISOR = 250.0;

/// Returns the radius of the disc that is counted: the mean of the penumbra widths r and t, in
/// metres; directional: as a tangent. Widths that are derived from the light's size are that size.
double compute_disc_radius(const LightSnapshot &p_light, const SceneSnapshot &p_scene) {
	const double unit_m = p_light.type == LightType::DIRECTIONAL ? p_scene.scene_size_m : 1.0;
	const double size = p_light.get_disc_radius();
	const double outer =
			p_light.is_outer_width_derived ? size : p_light.penumbra_outer_width_m / unit_m;
	const double inner =
			p_light.is_inner_width_derived ? size : p_light.penumbra_inner_width_m / unit_m;
	return 0.5 * (outer + inner);
}

} // namespace

void add_count_properties(PropertyList &r_list) {
	const std::string group = "Edge count";
	r_list.add({ "edge_count_quality", PropertyType::ENUM, std::string("256"), "64,256",
			"Points of the light that are counted where several casters overlap. More have finer "
			"steps there and cost time.",
			"", group });
	r_list.add({ "edge_count_budget", PropertyType::INT, int64_t(-1), "0,65536,1",
			"Edges that one block of 8 x 8 pixels may have. What has more is filtered with 64 "
			"taps, which is faster and less exact. -1: no limit; 0: all that has an edge is "
			"filtered.",
			"", group, /*special=*/"-1", "no limit" });
	r_list.add({ "edge_count_time_budget", PropertyType::FLOAT, -1.0, "0.1,1000,0.1",
			"GPU time that this light's shadow may take in a frame, as measured in the frames "
			"before. Where it is not enough, the blocks of 8 x 8 pixels with the most edges are "
			"counted with 64 points, then at one of 2 x 2 pixels, and then filtered. -1: no limit.",
			"ms", group, /*special=*/"-1", "no limit" });
	r_list.add({ "edge_count_interpolation", PropertyType::FLOAT, 0.5, "0,1,0.01",
			"Where the image of every edge on the light moves by no more than this share of the "
			"light's radius within a block of 8 x 8 pixels, 16 of these are counted and the others "
			"interpolated. More is faster and less exact; 0: each pixel is counted.",
			"", group });
	r_list.add_removed({ "edge_count_map_size",
			"There are no maps any more: faces are found in a tree, at the same cost "
			"everywhere." });
	r_list.add_removed(
			{ "edge_count_layers", "All solids in front of the light are counted exactly." });
}

CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties) {
	CountSettings settings;
	settings.sample_count = read_choice(p_properties, "edge_count_quality") == "256" ? 256 : 64;
	settings.interpolation = read_float(p_properties, "edge_count_interpolation");
	const int64_t budget = std::get<int64_t>(p_properties.at("edge_count_budget"));
	settings.budget = budget < 0 ? EDGE_COUNT_NO_BUDGET : static_cast<uint32_t>(budget);
	settings.time_budget_ms = std::get<double>(p_properties.at("edge_count_time_budget"));
	settings.disc_radius = compute_disc_radius(p_light, p_scene);
	return settings;
}

shader::CountLightConstants make_count_light_constants(
		const LightView &p_view, double p_disc_radius, double p_scene_size_m) {
	shader::CountLightConstants constants = {};
	const double depth_range_m = double(p_view.far_m) - p_view.near_m;
	constants.disc_radius = static_cast<float>(p_disc_radius);
	constants.depth_far_m = p_view.far_m;
	constants.nearer_tolerance = static_cast<float>(NEARER_TOLERANCE *
			(p_view.is_orthographic ? std::max(p_scene_size_m, depth_range_m / DEPTH_RANGE_DIVISOR)
									: 1.0));
	return constants;
}

} // namespace gnomon
