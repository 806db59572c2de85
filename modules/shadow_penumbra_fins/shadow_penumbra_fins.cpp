#include "modules/shadow_penumbra_fins/shadow_penumbra_fins.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/shadow_penumbra_fins/layer_passes.h"
#include "modules/shadows/mask.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t BORDER_PX = 2; // for bilinear lookups and search_neighbourhood's 3 x 3 texels

} // namespace

ShadowLimits ShadowPenumbraFins::get_limits(const PropertyValues & /*p_properties*/) const {
	// Wider fins overlap, and a texel holds only one fin: see the sweep fin_width in
	// doc/stability.md.
	if (!has_inner_half) {
		return { .max_outer_width_sizes = 0.075 };
	}
	return { .max_outer_width_sizes = 0.15, .max_inner_width_sizes = 0.15 };
}

void ShadowPenumbraFins::get_light_properties(PropertyList &r_list) const {
	add_fins_properties(id, has_inner_half, r_list);
}

void ShadowPenumbraFins::get_settings(PropertyList &r_list) const {
	add_fins_settings(has_inner_half, r_list);
}

void ShadowPenumbraFins::get_quality_settings(
		const LightSnapshot &p_light, std::vector<QualitySetting> &r_settings) const {
	const double size_m = p_light.size_m;
	r_settings.push_back({ has_inner_half ? "r = R/4, t = R/2" : "r = R/6",
			{ { "penumbra_outer_width", -1.0 }, { "penumbra_inner_width", -1.0 } } });
	if (size_m <= MAX_LENGTH_M) { // else beyond the range of explicit widths
		r_settings.push_back({ has_inner_half ? "r = t = R" : "r = R",
				{ { "penumbra_outer_width", size_m }, { "penumbra_inner_width", size_m } } });
	}
}

void ShadowPenumbraFins::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const FinsSettings view_settings =
			read_fins_view_settings(id, has_inner_half, p_light, p_properties);
	// Inner fins are inside their casters' outlines, so only outer fins enlarge the views.
	r_views = build_light_views(
			p_light, p_scene, view_settings.map_size_px, BORDER_PX, view_settings.outer_width_m);
}

void ShadowPenumbraFins::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	settings = read_fins_settings(id, has_inner_half, p_inputs);
	if (p_inputs.may_skip && settings.inner_width_m == 0 && settings.layer_count > 1) {
		r_plan.skip(settings.layer_count == 2 ? "layer 2" : "layers 2 and 3",
				"t is 0: only inner fins need them");
		settings.layer_count = 1;
	}
	// Without skipping, the fin passes run even if r and t are 0, and only clear the maps.
	draws_fins = settings.has_fins() || !p_inputs.may_skip;
	plan_views(p_inputs, r_plan);
	if (!views.is_all_empty()) {
		plan_fins(p_inputs, r_plan);
	}
}

void ShadowPenumbraFins::plan_views(const Inputs &p_inputs, TechniquePlan &r_plan) {
	views.begin(p_inputs, CachedViews::FilterReach::SINGLE_VIEW);
	bool has_content = !views.may_free_maps(); // if all views are empty: the maps stay as they are
	if (views.is_all_empty()) {
		if (views.may_free_maps()) {
			maps.reset();
		}
		maps.forget_frame();
	} else {
		has_content = maps.prepare(p_inputs.device, p_inputs.light.name, p_inputs.views[0].size_px,
				static_cast<uint32_t>(p_inputs.views.size()), settings.layer_count, draws_fins);
	}
	views.plan(p_inputs, r_plan, has_content && settings.gives_same_maps(drawn_settings));
	drawn_settings = settings;
}

void ShadowPenumbraFins::plan_fins(const Inputs &p_inputs, TechniquePlan &r_plan) {
	fin_casters = {};
	edge_lists = {};
	layer_texels = {};
	const std::vector<uint32_t> &drawn_views = views.get_needed_views();
	if (drawn_views.empty()) {
		return;
	}
	if (settings.layer_count > 1) {
		const auto one_pass_count =
				std::count_if(drawn_views.begin(), drawn_views.end(), [&](uint32_t p_view_index) {
					return choose_peeling(settings, p_inputs, p_view_index) == Peeling::ONE_PASS;
				});
		const auto peeled_count = static_cast<ptrdiff_t>(drawn_views.size()) - one_pass_count;
		for (const auto &[count, how] : { std::pair(peeled_count, "one after the other"),
					 std::pair(one_pass_count, "in one pass") }) {
			if (count > 0) {
				r_plan.run(text(settings.layer_count, " layers ", how, ", views: ", count));
			}
		}
	}
	const auto conditional_count = settings.layer_count < 3
			? 0
			: std::count_if(drawn_views.begin(), drawn_views.end(), [&](uint32_t p_view_index) {
				  return choose_peeling(settings, p_inputs, p_view_index) == Peeling::PASSES &&
						  is_layer_3_conditional(p_inputs, p_view_index);
			  });
	if (conditional_count > 0) {
		r_plan.run(text("layer 3 only if layer 2 is not empty, views: ", conditional_count));
	}
	if (!draws_fins) {
		r_plan.skip("fins", "r and t are 0: a plain shadow map");
		return;
	}
	fin_casters = build_silhouette_casters(
			p_inputs, collect_casters(p_inputs, drawn_views), get_vertices_per_edge(settings));
	const uint32_t zero_normal_count = count_zero_normals(fin_casters);
	r_plan.run(settings.method == FinMethod::GEOMETRY_SHADER ? "fins by geometry shader"
															 : "fins by compute");
	if (settings.has_fins() && settings.outer_width_m == 0) {
		r_plan.skip("outer fins", "r is 0");
	}
	if (has_inner_half && settings.has_fins() && settings.inner_width_m == 0) {
		r_plan.skip("inner fins", "t is 0");
	}
	if (zero_normal_count > 0) {
		r_plan.skip(text("fins at ", zero_normal_count, " vertices"),
				"the normals of their faces cancel");
	}
	if (fin_casters.collapsed_instance_count > 0) {
		r_plan.skip(text("fins of ", fin_casters.collapsed_instance_count, " instances"),
				"their transform collapses them to a line or a point");
	}
}

void ShadowPenumbraFins::before_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	maps.import(r_graph);
	add_layer_passes(r_graph, p_inputs, p_view_index, maps.get_layers(),
			choose_peeling(settings, p_inputs, p_view_index), layer_texels);
	views.set_drawn(p_inputs, p_view_index);
}

void ShadowPenumbraFins::at_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	if (!draws_fins) {
		return;
	}
	// Silhouettes depend only on the light's position, so all its views share one list.
	if (settings.method == FinMethod::COMPUTE && settings.has_fins() && !edge_lists.list &&
			!fin_casters.casters.empty()) {
		edge_lists = add_silhouette_passes(r_graph, p_inputs.device, fin_casters);
	}
	add_fin_pass(
			r_graph, p_inputs, p_view_index, settings, fin_casters, edge_lists, maps.get_targets());
}

RGTexture ShadowPenumbraFins::add_resolve_pass(
		RenderGraph &r_graph, const Inputs &p_inputs, const std::string &p_shader) {
	ComputePipelineDesc desc = { id + " " + p_shader,
		text("shadow_penumbra_fins/", p_shader, ".comp"), {} };
	const RGTexture output = create_tiled_mask(r_graph, p_inputs.size_px);
	const FinTargets targets = maps.get_targets();
	std::vector<PassBinding> bindings = make_map_resolve_bindings(r_graph, p_inputs);
	bindings.push_back(PassBinding::read(RESOLVE_BINDING_LAYER_1, targets.layer_1));
	bindings.push_back(
			PassBinding::write(RESOLVE_BINDING_OUTPUT, output, PassBuilder::Content::UPDATE));
	if (draws_fins) {
		desc.constants = { { FINS_CONSTANT_HAS_INNER, settings.inner_width_m > 0 ? 1u : 0u },
			{ FINS_CONSTANT_LAYER_COUNT, settings.layer_count },
			{ FINS_CONSTANT_CURVE, settings.curve },
			{ FINS_CONSTANT_STARTS_DARK, has_inner_half ? 0u : 1u } };
		if (!sampler) {
			sampler = OwnedSampler(p_inputs.device,
					p_inputs.device.create_sampler(
							{ "penumbra color", Filter::LINEAR, Filter::LINEAR }));
		}
		bindings.push_back(PassBinding::read(RESOLVE_BINDING_LAYER_3, maps.get_layer_3()));
		bindings.push_back(PassBinding::read(RESOLVE_BINDING_COLOR, targets.color, sampler.get()));
		bindings.push_back(
				PassBinding::read(RESOLVE_BINDING_PENUMBRA_DEPTH, targets.penumbra_depth));
	}
	const shader::FinsResolvePush push = { views.get_empty_views(), 0, 0, 0 };
	add_map_resolve_pass(r_graph, p_shader, p_inputs.device.get_compute_pipeline(desc),
			std::move(bindings), p_inputs, make_push_bytes(push));
	return output;
}

glm::vec2 ShadowPenumbraFins::compute_layer_range(const Inputs &p_inputs) const {
	uint32_t view_index = 0;
	while ((views.get_empty_views() & (1u << view_index)) != 0) {
		++view_index; // not all are empty
	}
	const shader::FinsViewConstants view =
			compute_fins_view_constants(p_inputs, view_index, settings);
	return view.is_orthographic != 0 ? glm::vec2(0.0f, 1.0f)
									 : view.depth_scale * glm::vec2(1.0f, 3.0f) / view.farthest_m;
}

RGTexture ShadowPenumbraFins::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	cases = {};
	if (views.is_all_empty()) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	maps.import(r_graph);
	if (p_inputs.wants_debug_views) {
		layer_range = compute_layer_range(p_inputs);
	}
	if (!draws_fins) {
		return add_resolve_pass(r_graph, p_inputs, "hard");
	}
	if (p_inputs.wants_debug_views) {
		cases = add_resolve_pass(r_graph, p_inputs, "cases");
	}
	return add_resolve_pass(r_graph, p_inputs, "resolve");
}

void ShadowPenumbraFins::get_debug_views(std::vector<DebugView> &r_views) const {
	if (!maps.is_imported()) {
		return;
	}
	for (size_t layer = 0; layer < maps.get_layers().size(); ++layer) {
		r_views.push_back({ text("layer_", layer + 1), maps.get_layers()[layer], layer_range });
	}
	if (cases) {
		const FinTargets targets = maps.get_targets();
		r_views.push_back({ "penumbra_color", targets.color });
		r_views.push_back({ "penumbra_depth", targets.penumbra_depth });
		r_views.push_back({ "case", cases, glm::vec2(0.0f, 6.0f), /*layer=*/0, /*class_count=*/7 });
	}
}

std::vector<std::string> ShadowPenumbraFins::get_shader_files() const {
	std::vector<std::string> files;
	for (const char *name :
			{ "peel.frag", "peel_flag.frag", "layers.frag", "fins.vert", "fins.geom",
					"edge_fins.vert", "fins.frag", "resolve.comp", "cases.comp", "hard.comp" }) {
		files.push_back(text("shadow_penumbra_fins/", name));
	}
	return files;
}

} // namespace gnomon
