#include "modules/shadow_edge_count/count_settings.h"

namespace gnomon {

namespace {

/// Of what a view sees, and of 45 degrees where it sees less: nothing beyond can hide a light that
/// is smaller than its distance to the casters.
const double LEAST_SLOPE = 1e-3;

} // namespace

void add_count_properties(PropertyList &r_list) {
	const std::string group = "Edge count";
	r_list.add({ "edge_count_quality", PropertyType::ENUM, std::string("256"), "64,256",
			"Points of the light that are counted where several casters overlap. More have finer "
			"steps there and cost time.",
			"", group });
	r_list.add({ "edge_count_map_size", PropertyType::INT, int64_t(256), "16,1024,16",
			"Width and height of each map that counts solids. Matters where casters that stand close "
			"together are as small as its texels.",
			"px", group });
	r_list.add({ "edge_count_layers", PropertyType::INT, int64_t(0), "0,16,1",
			"Solids, one behind the other, that the map counts at most; so it takes less time and "
			"memory. 0 counts all of them.",
			"", group });
	r_list.add({ "edge_count_budget", PropertyType::INT, int64_t(COUNT_DEFAULT_BUDGET), "0,65536,1",
			"Edges that one block of pixels may have; from 8192 on more in small pictures, whose "
			"blocks are few. Where there are more, a filter of 64 taps takes over. 0 counts "
			"nowhere.",
			"", group });
}

CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties) {
	const auto read_int = [&](const char *p_name) {
		return static_cast<uint32_t>(std::get<int64_t>(p_properties.at(p_name)));
	};
	CountSettings settings;
	settings.sample_count =
			std::get<std::string>(p_properties.at("edge_count_quality")) == "256" ? 256 : 64;
	settings.map_size_px = read_int("edge_count_map_size");
	settings.layer_count = read_int("edge_count_layers");
	settings.budget = read_int("edge_count_budget");
	// The mean of both penumbra widths. A directional light's are lengths, over S tangents.
	const double widths_m =
			0.5 * (double(p_light.penumbra_outer_width_m) + p_light.penumbra_inner_width_m);
	settings.disc_radius =
			p_light.type == LightType::DIRECTIONAL ? widths_m / p_scene.scene_size_m : widths_m;
	return settings;
}

CountSpace make_count_space(const LightView &p_view, double p_disc_radius, double p_scene_size_m) {
	CountSpace space;
	space.is_directional = p_view.is_orthographic;
	space.disc_radius = p_disc_radius;
	space.near_m = p_view.near_m;
	space.least_slope = LEAST_SLOPE /
			std::max(1.0, double(std::max(p_view.half_extent.x, p_view.half_extent.y)));
	space.depth_far_m = p_view.far_m;
	space.depth_range_m = double(p_view.far_m) - p_view.near_m;
	space.scene_size_m = p_scene_size_m;
	return space;
}

shader::CountViewConstants make_count_view_constants(
		const LightView &p_view, const CountSpace &p_space, uint32_t p_index) {
	shader::CountViewConstants constants = {};
	constants.disc_radius = static_cast<float>(p_space.disc_radius);
	// Directional only, where it does not depend on w.
	constants.depth_scale_m = static_cast<float>(p_space.get_depth_scale(1.0));
	constants.depth_far_m = static_cast<float>(p_space.depth_far_m);
	constants.scene_size_m = static_cast<float>(p_space.scene_size_m);
	constants.half_extent = p_view.half_extent;
	constants.map_size_px = p_view.size_px;
	constants.is_directional = p_space.is_directional ? 1 : 0;
	constants.near_m = static_cast<float>(p_space.near_m);
	constants.least_slope = static_cast<float>(p_space.least_slope);
	constants.index = p_index;
	return constants;
}

} // namespace gnomon
