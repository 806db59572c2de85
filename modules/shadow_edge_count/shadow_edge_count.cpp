#include "modules/shadow_edge_count/shadow_edge_count.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/renderer/lighting.h"
#include "modules/shadow_edge_count/disc_masks.h"
#include "modules/shadow_edge_count/view_passes.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t BORDER_PX = 2; // reference texels of receivers at the view's side

void check_device(const ShadowTechnique::Inputs &p_inputs) {
	const DeviceFeatures &features = p_inputs.device.get_features();
	if (!features.fragment_stores || !features.subgroup_operations) {
		fail("Light \"", p_inputs.light.name, "\": edge_count needs ",
				features.fragment_stores ? "subgroup vote, arithmetic and ballot in compute shaders"
										 : "stores and atomics in fragment shaders",
				", which ", p_inputs.device.get_info().name,
				" lacks. Set another shadow_technique; `gnomon techniques` lists them.");
	}
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

void ShadowEdgeCount::get_light_views(const LightSnapshot &p_light, const SceneSnapshot &p_scene,
		const PropertyValues &p_properties, std::vector<LightView> &r_views) const {
	const CountSettings view_settings = read_count_settings(p_light, p_scene, p_properties);
	// A directional light's view holds all casters, and what lies beside it has none before it.
	const float margin_m = p_light.type == LightType::DIRECTIONAL
			? 0.0f
			: static_cast<float>(view_settings.disc_radius);
	r_views = build_light_views(p_light, p_scene, view_settings.map_size_px, BORDER_PX, margin_m);
}

void ShadowEdgeCount::plan(const Inputs &p_inputs, TechniquePlan &r_plan) {
	debug_picture = {};
	settings = read_count_settings(p_inputs.light, p_inputs.scene, p_inputs.properties);
	views.begin(p_inputs, KeptViews::Reads::ACROSS_VIEWS);
	const uint32_t view_count = static_cast<uint32_t>(p_inputs.views.size());
	const auto plan_nothing = [&] {
		if (views.may_forget()) {
			buffers.reset();
			found.clear();
		}
		views.plan(p_inputs, r_plan, found.size() == view_count);
	};
	if (views.is_all_empty()) {
		return plan_nothing();
	}
	uint32_t most_edges = 0;
	uint32_t edge_count = 0;
	uint64_t fragment_bound = 0;
	std::vector<CountCasters> casters;
	empty_views = 0;
	for (uint32_t view = 0; view < view_count; ++view) {
		casters.push_back(build_count_casters(p_inputs, view));
		most_edges = std::max(most_edges, casters.back().edge_count);
		edge_count += casters.back().edge_count;
		fragment_bound = std::max(fragment_bound, casters.back().fragment_bound);
		empty_views |= casters.back().edge_count == 0 ? 1u << view : 0u;
	}
	check_device(p_inputs);
	const CountCapacities wanted = choose_capacities(view_count, p_inputs.views[0].size_px,
			most_edges, fragment_bound, settings.layer_count);
	settings.budget = choose_budget(p_inputs.size_px, settings.budget, edge_count);
	const auto may_filter = [&](const CountCapacities &p_capacities) {
		const bool may_lack_room = most_edges > p_capacities.records_per_view ||
				(settings.layer_count == 0 && fragment_bound > p_capacities.fragments_per_view);
		return edge_count > settings.budget || may_lack_room || !p_inputs.may_leave_out;
	};
	if (!may_filter(wanted)) {
		// Only filters read beyond the view of a receiver.
		views.begin(p_inputs, KeptViews::Reads::OWN_VIEW);
		if (views.is_all_empty()) {
			return plan_nothing(); // takes no memory for what nobody sees
		}
	}
	const bool has_content = buffers.prepare(p_inputs.device, p_inputs.light.name, wanted);
	may_be_over = may_filter(buffers.get_capacities());
	empty_views |= views.get_empty_views();
	if (!has_content || found.size() != view_count) {
		found.assign(view_count, {});
	}
	views.plan(p_inputs, r_plan,
			has_content && drawn_disc_radius == settings.disc_radius &&
					drawn_layer_count == settings.layer_count);
	drawn_disc_radius = settings.disc_radius;
	drawn_layer_count = settings.layer_count;
	plan_edges(p_inputs, casters, r_plan);
	if (may_be_over) {
		r_plan.run(text("filter where a block has more than ", settings.budget, " edges"));
	} else {
		r_plan.leave_out(text("filter where a block has more than ", settings.budget, " edges"),
				text("all casters together have ", edge_count));
	}
}

void ShadowEdgeCount::plan_edges(
		const Inputs &p_inputs, std::vector<CountCasters> &r_casters, TechniquePlan &r_plan) {
	const bool may_keep = p_inputs.may_leave_out && p_inputs.may_keep;
	uint32_t kept_count = 0;
	uint32_t moved_count = 0;
	uint32_t flat_count = 0;
	for (const uint32_t view : views.get_wanted_views()) {
		FoundView &before = found[view];
		const bool has_view_content = buffers.prepare_view(p_inputs.device, view, r_casters[view]);
		if (has_view_content && may_keep && before.view == p_inputs.views[view] &&
				before.disc_radius == settings.disc_radius) {
			compare_casters(before.casters, r_casters[view]);
		}
		flat_count = std::max(flat_count, r_casters[view].flat_instance_count);
		for (const CountCaster &caster : r_casters[view].casters) {
			++(caster.is_moved ? moved_count : kept_count);
		}
		before = { p_inputs.views[view], settings.disc_radius, std::move(r_casters[view]) };
	}
	if (moved_count > 0) {
		r_plan.run(text("find edges, casters: ", moved_count));
	}
	if (kept_count > 0) {
		r_plan.leave_out(text("find edges, casters: ", kept_count),
				"kept: neither the light nor the caster moved");
	}
	if (flat_count > 0) {
		r_plan.leave_out(text("edges of instances: ", flat_count), "a scale of theirs is 0");
	}
}

void ShadowEdgeCount::at_light_view(
		RenderGraph &r_graph, const Inputs &p_inputs, uint32_t p_view_index) {
	views.set_drawn(p_inputs, p_view_index);
	if ((empty_views & (1u << p_view_index)) != 0) {
		return; // none of its casters has a face
	}
	const LightView &view = p_inputs.views[p_view_index];
	const CountViewPasses passes = { p_view_index, view.size_px, settings.layer_count,
		r_graph.upload_constants("counted view",
				make_count_view_constants(view,
						make_count_space(view, settings.disc_radius, p_inputs.scene.scene_size_m),
						p_view_index)),
		found[p_view_index].casters, buffers.get_capacities(), buffers.import(r_graph),
		buffers.import_view(r_graph, p_view_index) };
	add_find_passes(r_graph, p_inputs.device, passes);
	add_layer_passes(r_graph, p_inputs.device, passes);
}

RGBuffer ShadowEdgeCount::import_masks(RenderGraph &r_graph, const Inputs &p_inputs) {
	const uint32_t turn_count = settings.sample_count / DiscMasks::SAMPLE_COUNT;
	if (!masks || mask_turn_count != turn_count) {
		std::vector<uint64_t> tables;
		for (uint32_t turn = 0; turn < turn_count; ++turn) {
			const DiscMasks table(turn);
			tables.insert(tables.end(), table.get_table().begin(), table.get_table().end());
		}
		const auto bytes = bytes_of(std::span<const uint64_t>(tables));
		masks = OwnedBuffer(p_inputs.device,
				p_inputs.device.create_buffer_with_data(
						{ "masks of " + p_inputs.light.name, bytes.size(),
								BufferUsage::TEXEL | BufferUsage::COPY_TARGET, MemoryKind::GPU,
								Format::RG32_UINT },
						bytes));
		mask_turn_count = turn_count;
	}
	return r_graph.import_buffer(masks.get());
}

RGTexture ShadowEdgeCount::resolve(RenderGraph &r_graph, const Inputs &p_inputs) {
	if (views.is_all_empty() || empty_views == ~0u >> (32 - p_inputs.views.size())) {
		return add_constant_mask(r_graph, p_inputs.size_px, 1.0f);
	}
	const CountBlockPasses passes = { p_inputs, settings, buffers.import(r_graph),
		buffers.get_capacities(), empty_views, import_masks(r_graph, p_inputs), may_be_over };
	if (!views.get_wanted_views().empty()) {
		buffers.add_readback(r_graph);
	}
	const CountBlocks blocks = add_block_passes(r_graph, passes);
	if (p_inputs.wants_debug_views) {
		debug_picture = add_count_debug_pass(r_graph, passes, blocks);
	}
	return add_count_passes(r_graph, passes, blocks);
}

void ShadowEdgeCount::get_debug_views(std::vector<DebugView> &r_views) const {
	if (debug_picture) {
		r_views.push_back(
				{ "edges", debug_picture, glm::vec2(0.0f, 64.0f), EDGE_COUNT_DEBUG_EDGES });
		r_views.push_back(
				{ "layers", debug_picture, glm::vec2(0.0f, 7.0f), EDGE_COUNT_DEBUG_SOLIDS, 8 });
		r_views.push_back(
				{ "blocks", debug_picture, glm::vec2(0.0f, 2.0f), EDGE_COUNT_DEBUG_BLOCKS, 3 });
	}
}

std::vector<std::string> ShadowEdgeCount::get_shader_files() const {
	std::vector<std::string> files;
	for (const char *name : { "face_planes.comp", "mark_edges.comp", "list_edges.comp",
				 "bound_edges.comp", "layers.vert", "count_layers.frag", "sum_layers.comp",
				 "place_layers.comp", "fill_layers.frag", "place_nearest.comp",
				 "nearest_layers.frag", "bury_texels.comp", "receiver_boxes.comp",
				 "list_blocks.comp", "resolve_plain.comp", "resolve.comp", "resolve_fine.comp",
				 "filter_map.comp", "filter_blocks.comp", "debug.comp" }) {
		files.push_back(text("shadow_edge_count/", name));
	}
	return files;
}

} // namespace gnomon
