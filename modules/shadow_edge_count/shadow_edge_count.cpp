#include "modules/shadow_edge_count/shadow_edge_count.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/shadow_edge_count/disc_masks.h"
#include "modules/shadow_edge_count/find_passes.h"
#include "modules/shadows/caster_pass.h"
#include "modules/shadows/fetched_buffers.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/scene_summary.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t DEPTH_MAP_SIZE_PX = 1024; // for leaves over budget; as the default of pcss
constexpr uint32_t BORDER_PX = 1;			 // of the filter, at the edge of a view

void check_device(const ShadowTechnique::Inputs &p_inputs) {
	if (!p_inputs.device.get_features().subgroup_operations) {
		fail("Light \"", p_inputs.light.name,
				"\": edge_count needs subgroup vote, arithmetic, ballot and shuffle in compute "
				"shaders, which ",
				p_inputs.device.get_info().name,
				" lacks. Set another shadow_technique; `gnomon techniques` lists them.");
	}
}

/// Hashes all that the result of build_count_casters depends on, except for the casters.
uint64_t compute_light_hash(
		const ShadowTechnique::Inputs &p_inputs, const CountSettings &p_settings) {
	uint64_t hash = compute_value_hash(p_settings.disc_radius, /*p_seed=*/2);
	hash = p_inputs.light.compute_hash(hash);
	hash = compute_value_hash(p_inputs.light.penumbra_outer_width_m, hash);
	hash = compute_value_hash(p_inputs.light.penumbra_inner_width_m, hash);
	for (const LightView &view : p_inputs.views) {
		hash = compute_value_hash(view.view_from_world, hash);
		hash = compute_value_hash(view.half_extent, hash);
	}
	return compute_value_hash(p_inputs.scene.scene_size_m, hash);
}

/// Equal for equal results of build_count_casters. p_hash: of compute_light_hash.
uint64_t compute_casters_hash(const ShadowTechnique::Inputs &p_inputs, uint64_t p_hash) {
	for (const CasterList &casters : p_inputs.casters) {
		p_hash = compute_value_hash(casters.content_hash, p_hash);
	}
	p_hash = compute_value_hash(p_inputs.summary.get_bounds().minimum, p_hash);
	return compute_value_hash(p_inputs.summary.get_bounds().maximum, p_hash);
}

} // namespace

void ShadowEdgeCount::get_light_properties(PropertyList &r_list) const {
	add_count_properties(r_list);
}

void ShadowEdgeCount::get_quality_settings(
		const LightSnapshot & /*p_light*/, std::vector<QualitySetting> &r_settings) const {
	for (const char *points : { "64", "256" }) {
		r_settings.push_back(
				{ text(points, " points"), { { "edge_count_quality", std::string(points) } } });
	}
}

void ShadowEdgeCount::get_light_views(const LightSnapshot &p_light, const LightScene &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	// Where the light's centre is exactly a caster's vertex, rounding decides whether it is inside
	// the caster, and differently for its faces. A centre moved by more than the rounding, but by
	// a fraction of the radius that changes no visibility by more than about as much, is at no
	// vertex. The direction is no axis of any model.
	const glm::dvec3 SHIFT_DIRECTION(0.41, -0.73, 0.55);
	const CountSettings view_settings = read_count_settings(p_light, p_scene.scene, p_properties);
	LightSnapshot light = p_light;
	if (light.type != LightType::DIRECTIONAL) {
		const double radius_m = view_settings.disc_radius;
		light.position_world += SHIFT_DIRECTION *
				std::clamp(2e-6 * p_scene.scene.scene_size_m, 1e-4 * radius_m, 2e-3 * radius_m);
	}
	// A directional light's view contains all casters, so nothing can hide receivers outside it.
	const float margin_m = p_light.type == LightType::DIRECTIONAL
			? 0.0f
			: static_cast<float>(view_settings.disc_radius);
	r_views = build_light_views(light, p_scene, DEPTH_MAP_SIZE_PX, BORDER_PX, margin_m);
}

CasterLimits ShadowEdgeCount::find_caster_limits(const RenderingDevice &p_device) const {
	const uint64_t bytes = p_device.get_features().max_storage_buffer_bytes;
	return { std::min<uint64_t>(MAX_CASTER_FACES, bytes / sizeof(shader::CountFaceRecord)),
		std::min<uint64_t>(MAX_CASTER_FACES, bytes / sizeof(shader::CountEdgeRecord)) };
}

void ShadowEdgeCount::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	debug_image = {};
	frame_depth_map = {};
	are_casters_found = false;
	settings = read_count_settings(p_inputs.light, p_inputs.scene, p_inputs.properties);
	// In a large world, what did not change is not looked through again.
	const uint64_t light_hash = compute_light_hash(p_inputs, settings);
	uint64_t casters_hash = compute_casters_hash(p_inputs, light_hash);
	chosen.update(
			p_inputs, settings.disc_radius, casters_hash, find_caster_limits(p_inputs.device));
	casters_hash = compute_value_hash(chosen.get_revision(), casters_hash);
	const bool may_reuse =
			p_inputs.may_skip && p_inputs.may_reuse && !cached.casters.casters.empty();
	bool is_same = may_reuse && cached.casters_hash == casters_hash;
	std::optional<MovedCasters> moved;
	if (may_reuse && !is_same && cached.light_hash == light_hash) {
		moved = find_moved_casters(p_inputs, chosen.get(), cached.casters, order);
	}
	CountCasters built;
	if (!is_same && !moved) {
		built = build_count_casters(p_inputs, chosen.get(), settings.disc_radius, order);
	}
	const CountCasters &casters = is_same || moved ? cached.casters : built;
	may_exceed_budget =
			settings.has_budget() && (casters.edge_count > settings.budget || !p_inputs.may_skip);
	may_filter = may_exceed_budget || settings.has_time_budget();
	// Only the filter reads views other than that of the receiver.
	views.begin(p_inputs,
			may_filter ? CachedViews::FilterReach::ADJACENT_VIEWS
					   : CachedViews::FilterReach::SINGLE_VIEW);
	has_casters = casters.face_count > 0;
	if (views.is_all_empty() || !has_casters) {
		if (views.may_free_maps() || !has_casters) {
			buffers.reset();
			depth_map.reset();
			cached = {};
		}
		views.plan(p_inputs, r_plan, !cached.casters.casters.empty());
		return;
	}
	check_device(p_inputs);
	const bool has_content =
			buffers.prepare(p_inputs.device, p_inputs.light.name, choose_capacities(casters)) &&
			cached.disc_radius == settings.disc_radius &&
			(is_same || moved || cached.casters.has_layout_of(casters)) &&
			(!may_filter || cached.has_depth_map);
	if ((is_same || moved) &&
			!has_content) { // meshes that were not read for some frames may be gone
		built = build_count_casters(p_inputs, chosen.get(), settings.disc_radius, order);
		is_same = false;
		moved.reset();
	}
	if (!is_same && !moved && has_content && p_inputs.may_skip && p_inputs.may_reuse &&
			cached.first_view == p_inputs.views[0]) {
		compare_casters(cached.casters, built);
	}
	views.plan(p_inputs, r_plan, has_content);
	cached.disc_radius = settings.disc_radius;
	cached.has_depth_map = may_filter;
	if (!may_filter) {
		depth_map.reset();
	}
	if (!views.get_needed_views().empty()) {
		p_inputs.meshes.get_shared<CountMeshPools>().upload();
		cached.first_view = p_inputs.views[0];
		if (moved) {
			moved->apply_to(cached.casters);
		} else if (!is_same) {
			cached.casters = std::move(built);
		}
		cached.casters_hash = casters_hash;
		cached.light_hash = light_hash;
		plan_casters(r_plan);
	}
	plan_filter(r_plan);
	plan_rungs(r_plan);
	if (!settings.has_time_budget()) {
		time_budget.reset();
	} else if (!time_budget) {
		time_budget.emplace(p_inputs.device.get_features().runs_on_cpu);
	}
}

void ShadowEdgeCount::plan_casters(TechniquePlan &r_plan) {
	const CountCasters &casters = cached.casters;
	const size_t coarse_count = casters.coarse_count;
	const auto moved_count =
			static_cast<size_t>(std::count_if(casters.moved.begin(), casters.moved.end(),
					[&](uint32_t p_index) { return !casters.casters[p_index].is_coarse; }));
	const size_t reused_count = casters.casters.size() - coarse_count - moved_count;
	if (coarse_count > 0) {
		r_plan.run(text("coarse outlines where the penumbra is wide, casters: ", coarse_count));
	}
	if (moved_count > 0) {
		r_plan.run(text("find edges, casters: ", moved_count));
	}
	if (reused_count > 0) {
		r_plan.skip(text("find edges, casters: ", reused_count),
				"cached: neither the light nor the caster moved");
	}
	if (chosen.get_skipped_count() > 0) {
		r_plan.skip(text("find edges, casters: ", chosen.get_skipped_count()),
				"their shadows reach nothing that the camera sees, and all have too many "
				"triangles");
	}
	if (casters.collapsed_instance_count > 0) {
		r_plan.skip(text("edges of instances: ", casters.collapsed_instance_count),
				"their transform collapses them to a line or a point");
	}
	if (settings.disc_radius <= 0) {
		r_plan.skip("edges", "the light has no size");
	}
	if (casters.may_cut_disc) {
		r_plan.run("faces that cut the light's disc");
	} else if (cached.disc_radius > 0) {
		r_plan.skip("faces that cut the light's disc", "no caster comes so near to its centre");
	}
}

void ShadowEdgeCount::plan_filter(TechniquePlan &r_plan) {
	if (!settings.has_budget()) {
		if (!settings.has_time_budget()) { // else plan_rungs reports what is filtered
			r_plan.skip("filter", "edge_count_budget is -1: nothing has too many edges");
		}
		return;
	}
	const std::string pass = text("filter where there are more than ", settings.budget, " edges");
	if (may_exceed_budget) {
		r_plan.run(pass);
	} else {
		r_plan.skip(pass, text("all casters together have ", cached.casters.edge_count));
	}
}

void ShadowEdgeCount::plan_rungs(TechniquePlan &r_plan) {
	if (!settings.has_time_budget()) {
		r_plan.skip("fewer points, fewer pixels", "edge_count_time_budget is -1: no limit");
		return;
	}
	const std::string pass = text("within ", settings.time_budget_ms, " ms");
	const std::optional<CountRungs> rungs = status.get_rungs();
	if (!rungs) {
		r_plan.run(text(pass, ", no leaf was counted yet"));
		return;
	}
	const auto count = [&](uint32_t p_rung) { return rungs->leaf_counts[p_rung]; };
	const uint32_t few_points = settings.get_sample_set_count() > 1
			? count(EDGE_COUNT_RUNG_FEW_POINTS)
			: 0; // those leaves are counted as all others
	r_plan.run(text(pass, ", leaves in the frame before: full ",
			count(EDGE_COUNT_RUNG_FULL) + count(EDGE_COUNT_RUNG_FEW_POINTS) - few_points,
			", 64 points ", few_points, ", 16 of 64 pixels ", count(EDGE_COUNT_RUNG_FEW_PIXELS),
			", filtered ", count(EDGE_COUNT_RUNG_FILTERED)));
}

void ShadowEdgeCount::receive_times(std::span<const PassTiming> p_passes) {
	const std::optional<CountRungs> rungs = status.get_rungs();
	if (time_budget && rungs) {
		time_budget->learn(p_passes, rungs->cost);
	}
}

void ShadowEdgeCount::at_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	views.set_drawn(p_inputs, p_view_index);
	if (!has_casters) {
		return;
	}
	if (!are_casters_found) {
		add_find_passes(r_graph, p_inputs.device,
				{ cached.casters, p_inputs.meshes.get_shared<CountMeshPools>(),
						buffers.get_capacities(), buffers.import(r_graph),
						r_graph.upload_constants("counted casters",
								make_leaf_constants(p_inputs, settings, buffers.get_capacities(),
										/*p_empty_views=*/0)),
						p_inputs.views.front().is_orthographic });
		are_casters_found = true;
	}
	if (may_filter) {
		add_depth_pass(r_graph, text("depth view ", p_view_index), p_inputs,
				p_inputs.views[p_view_index], p_inputs.casters[p_view_index],
				import_depth_map(r_graph, p_inputs), p_view_index);
	}
}

RGTexture ShadowEdgeCount::import_depth_map(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (!frame_depth_map) {
		const TextureDesc desc = { "depth map of " + p_inputs.light.name, Format::D32_SFLOAT,
			glm::uvec2(DEPTH_MAP_SIZE_PX), static_cast<uint32_t>(p_inputs.views.size()),
			TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED, /*is_array=*/true };
		const bool has_content = bool(depth_map);
		if (!has_content) {
			depth_map = OwnedTexture(p_inputs.device, p_inputs.device.create_texture(desc));
		}
		frame_depth_map = r_graph.import_texture(depth_map.get(),
				has_content ? RenderGraph::ImportedContent::PRESERVED
							: RenderGraph::ImportedContent::NONE);
	}
	return frame_depth_map;
}

OwnedBuffer ShadowEdgeCount::make_masks(const Inputs &p_inputs, uint32_t p_point_count) {
	// The tables of all sets are interleaved, since the shader reads the masks of two sets at once.
	const uint32_t set_count = p_point_count / EDGE_COUNT_SAMPLE_COUNT;
	std::vector<uint64_t> tables;
	for (uint32_t sample_set = 0; sample_set < set_count; ++sample_set) {
		const DiscMasks disc_masks(sample_set, set_count);
		const std::vector<uint64_t> &table = disc_masks.get_table();
		tables.resize(table.size() * set_count);
		for (size_t i = 0; i < table.size(); ++i) {
			tables[i * set_count + sample_set] = table[i];
		}
	}
	const auto bytes = bytes_of(std::span<const uint64_t>(tables));
	return OwnedBuffer(p_inputs.device,
			p_inputs.device.create_buffer_with_data(
					{ text("masks of ", p_point_count, " points"), bytes.size(),
							BufferUsage::TEXEL | BufferUsage::COPY_TARGET, MemoryKind::GPU,
							set_count == 1 ? Format::RG32_UINT : Format::RGBA32_UINT },
					bytes));
}

void ShadowEdgeCount::prepare_masks(const Inputs &p_inputs) {
	if (!masks || mask_point_count != settings.sample_count) {
		masks = make_masks(p_inputs, settings.sample_count);
		mask_point_count = settings.sample_count;
	}
	if (!settings.has_time_budget()) {
		few_masks.reset();
		ladder.reset();
		return;
	}
	if (settings.sample_count == EDGE_COUNT_SAMPLE_COUNT) {
		few_masks.reset();
	} else if (!few_masks) {
		few_masks = make_masks(p_inputs, EDGE_COUNT_SAMPLE_COUNT);
	}
	if (!ladder || !p_inputs.may_reuse) {
		const uint32_t start = 0;
		ladder = OwnedBuffer(p_inputs.device,
				p_inputs.device.create_buffer_with_data(
						{ "ladder of " + p_inputs.light.name, sizeof(start),
								BufferUsage::STORAGE | BufferUsage::COPY_TARGET },
						bytes_of(std::span(&start, 1))));
	}
}

RGTexture ShadowEdgeCount::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	probe.reset();
	const uint32_t empty_views = views.get_empty_views() | cached.casters.empty_views;
	if (!has_casters || views.is_all_empty() ||
			empty_views == ~0u >> (32 - p_inputs.views.size())) {
		return add_constant_mask(r_graph, p_inputs.size_px, /*p_visibility=*/1.0f);
	}
	prepare_masks(p_inputs);
	CountLeafPasses passes = { .inputs = p_inputs,
		.settings = settings,
		.light = buffers.import(r_graph),
		.capacities = buffers.get_capacities(),
		.empty_views = empty_views,
		.masks = r_graph.import_buffer(masks.get()) };
	if (time_budget) {
		passes.few_masks = few_masks ? r_graph.import_buffer(few_masks.get()) : passes.masks;
		passes.ladder = r_graph.import_buffer(ladder.get());
		passes.cost_limit = find_cost_limit();
	}
	if (may_filter) {
		passes.depth_map = import_depth_map(r_graph, p_inputs);
	}
	const CountLeaves leaves = add_leaf_passes(r_graph, passes);
	after_lists(r_graph, passes.light, leaves);
	if (p_inputs.wants_debug_views || p_inputs.wants_explanation) {
		debug_image = add_count_debug_pass(r_graph, passes, leaves);
	}
	const RGTexture mask = add_count_passes(r_graph, passes, leaves);
	if (p_inputs.wants_explanation) {
		probe.emplace(p_inputs, settings, buffers.get_capacities());
		probe->add_read_back(r_graph, passes.light, leaves, debug_image, mask);
	}
	status.add_read_back(r_graph, leaves.status, p_inputs.light.name);
	return mask;
}

void ShadowEdgeCount::get_debug_views(std::vector<DebugView> &r_views) const {
	if (debug_image) {
		r_views.push_back({ "edges", debug_image, glm::vec2(0.0f, 64.0f), EDGE_COUNT_DEBUG_EDGES });
		r_views.push_back({ "solids", debug_image, glm::vec2(0.0f, 7.0f), EDGE_COUNT_DEBUG_SOLIDS,
				/*class_count=*/8 });
		r_views.push_back({ "leaves", debug_image, glm::vec2(0.0f, 5.0f), EDGE_COUNT_DEBUG_LEAVES,
				EDGE_COUNT_LEAF_KINDS });
	}
}

void ShadowEdgeCount::explain(const ProbedReceiver &p_receiver, ProbeEntry &r_explanation) const {
	if (probe) {
		probe->explain(p_receiver, cached.casters, r_explanation);
	} else {
		ProbeEntry &values = r_explanation.add("visibility");
		values.add("mask", p_receiver.visibility);
		values.add("all_found", 1.0);
		r_explanation.add_list("notes").add(
				"", "No opaque caster is in front of the light: nothing was counted.");
		r_explanation.add_list("findings");
	}
}

std::vector<std::string> ShadowEdgeCount::get_shader_files() const {
	std::vector<std::string> files;
	for (const char *name : { "bound_nodes.comp", "resolve_dark.comp", "filter_leaves.comp",
				 "choose_rungs.comp" }) {
		files.push_back(text("shadow_edge_count/", name));
	}
	for (const char *name : { "caster_faces.comp", "mark_edges.comp", "list_edges.comp",
				 "bound_clusters.comp", "list_cut_faces.comp", "find_leaves.comp",
				 "list_leaves.comp", "count_solids.comp", "resolve.comp", "resolve_few_pixels.comp",
				 "resolve_unfinished.comp", "debug.comp" }) {
		files.push_back(text("shadow_edge_count/", name));
		files.push_back(get_storage_variant(files.back()));
	}
	return files;
}

} // namespace gnomon
