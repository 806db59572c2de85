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

/// Returns edge_count_map_size if it is -1. Large faces have an entry in each texel that they
/// cover, in each of an omni light's maps, which together serve no more pixels than one spot
/// light's.
uint32_t derive_map_size(const LightSnapshot &p_light, const SceneSnapshot &p_scene) {
	const uint64_t MAX_FEW_TRIANGLES = 20'000;
	uint64_t triangle_count = 0;
	for (const InstanceSnapshot &instance : p_scene.instances) {
		triangle_count += instance.casts_shadow ? instance.caster_mesh->get_triangle_count() : 0;
	}
	return p_light.type == LightType::OMNI && triangle_count <= MAX_FEW_TRIANGLES ? 128 : 256;
}

} // namespace

void add_count_properties(PropertyList &r_list) {
	const std::string group = "Edge count";
	r_list.add({ "edge_count_quality", PropertyType::ENUM, std::string("256"), "64,256",
			"Points of the light that are counted where several casters overlap. More have finer "
			"steps there and cost time.",
			"", group });
	r_list.add({ "edge_count_map_size", PropertyType::INT, int64_t(-1), "16,1024,16",
			"Width and height of each map whose texels list the faces above them. It changes time "
			"and memory, and the mask only by rounding: more texels have shorter lists. -1: 128 "
			"for an omni light, whose six maps share the image, if at most 20,000 triangles cast "
			"shadows, else 256.",
			"px", group, /*special=*/"-1", "derived" });
	r_list.add({ "edge_count_budget", PropertyType::INT, int64_t(-1), "0,65536,1",
			"Edges that one block of 8 x 8 pixels may have. Blocks with more are filtered with 64 "
			"taps, which is faster and less exact. -1: no limit; 0: every block that has an edge "
			"is filtered.",
			"", group, /*special=*/"-1", "no limit" });
	r_list.add({ "edge_count_interpolation", PropertyType::FLOAT, 0.5, "0,1,0.01",
			"Where the image of every edge on the light moves by no more than this share of the "
			"light's radius within a block of 8 x 8 pixels, 16 of these are counted and the others "
			"interpolated. More is faster and less exact; 0: each pixel is counted.",
			"", group });
	r_list.add_removed(
			{ "edge_count_layers", "All solids in front of the light are counted exactly." });
}

CountSettings read_count_settings(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties) {
	CountSettings settings;
	settings.sample_count =
			std::get<std::string>(p_properties.at("edge_count_quality")) == "256" ? 256 : 64;
	const int64_t map_size = std::get<int64_t>(p_properties.at("edge_count_map_size"));
	settings.map_size_px =
			map_size < 0 ? derive_map_size(p_light, p_scene) : static_cast<uint32_t>(map_size);
	settings.interpolation =
			static_cast<float>(std::get<double>(p_properties.at("edge_count_interpolation")));
	const int64_t budget = std::get<int64_t>(p_properties.at("edge_count_budget"));
	settings.budget = budget < 0 ? EDGE_COUNT_NO_BUDGET : static_cast<uint32_t>(budget);
	settings.disc_radius = compute_disc_radius(p_light, p_scene);
	return settings;
}

shader::CountLightConstants make_count_light_constants(
		const std::vector<LightView> &p_views, double p_disc_radius, double p_scene_size_m) {
	shader::CountLightConstants constants = {};
	const LightView &first = p_views.front();
	const glm::dmat3 light_from_world(first.view_from_world);
	for (size_t index = 0; index < p_views.size(); ++index) {
		const LightView &view = p_views[index];
		const glm::dmat3 light_from_view =
				light_from_world * glm::transpose(glm::dmat3(view.view_from_world));
		constants.views[index] = { glm::vec4(glm::vec3(light_from_view[0]), 0.0f),
			glm::vec4(glm::vec3(light_from_view[1]), 0.0f),
			glm::vec4(glm::vec3(light_from_view[2]), 0.0f), view.half_extent, view.size_px };
	}
	const double depth_range_m = double(first.far_m) - first.near_m;
	constants.disc_radius = static_cast<float>(p_disc_radius);
	constants.depth_far_m = first.far_m;
	constants.scene_size_m = static_cast<float>(p_scene_size_m);
	constants.nearer_tolerance = static_cast<float>(NEARER_TOLERANCE *
			(first.is_orthographic ? std::max(p_scene_size_m, depth_range_m / DEPTH_RANGE_DIVISOR)
								   : 1.0));
	constants.view_count = static_cast<uint32_t>(p_views.size());
	return constants;
}

} // namespace gnomon
