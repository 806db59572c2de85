#include "modules/shadow_edge_count/leaf_passes.h"

#include "modules/core/text.h"
#include "modules/render_graph/fill_pass.h"
#include "modules/shadows/fetched_buffers.h"
#include "modules/shadows/mask.h"
#include "modules/shadows/nearest_caster.h"

#include "shared/lit_tiles_shared.h"

#include <algorithm>
#include <bit>

namespace gnomon {

namespace {

// Capacity of all lists together: an average per block of pixels, and at most 23 MB at 4 bytes per
// word. Leaves whose lists do not fit take more time, but are still exact.
constexpr uint64_t LIST_WORDS_PER_BLOCK = 2048;
constexpr uint64_t MAX_LIST_WORDS = 5'700'000;
// Every block of pixels has room for one leaf, and half of them for a second one. More are in few
// blocks, and those whose leaves are completely lit need none.
constexpr uint32_t LEAVES_PER_TWO_BLOCKS = 3;
// Leaves of a chunk (see CountLeafPush), so that no dispatch takes 100 ms: 20 us a leaf are usual
// on a CPU with two cores.
constexpr uint32_t CPU_CHUNK_LEAVES = 4096;
constexpr uint32_t GPU_CHUNK_LEAVES = 16384;

glm::uvec2 divide_up(glm::uvec2 p_value, uint32_t p_divisor) {
	return (p_value + (p_divisor - 1)) / p_divisor;
}

/// The bindings of every pass over the leaves of one kind, see resolve_leaf_inc.glsl.
std::vector<PassBinding> make_kind_bindings(const CountLeaves &p_leaves) {
	std::vector<PassBinding> bindings = p_leaves.receivers;
	bindings.push_back(PassBinding::constants(COUNT_BINDING_LIGHT, p_leaves.constants));
	bindings.push_back(PassBinding::read(COUNT_BINDING_LEAVES, p_leaves.leaves));
	bindings.push_back(PassBinding::read(COUNT_BINDING_KINDS, p_leaves.kinds));
	bindings.push_back(PassBinding::read(COUNT_BINDING_COUNTS, p_leaves.counts));
	return bindings;
}

/// The bindings of passes that read the light's faces and edges, see light_items_inc.glsl.
void bind_light_items(const CountFrameBuffers &p_light, std::vector<PassBinding> &r_bindings) {
	r_bindings.push_back(PassBinding::read(COUNT_BINDING_FACES, p_light.faces));
	r_bindings.push_back(PassBinding::read(COUNT_BINDING_PLANES, p_light.planes));
	r_bindings.push_back(PassBinding::read(COUNT_BINDING_EDGES, p_light.edges));
	r_bindings.push_back(PassBinding::read(COUNT_BINDING_NODES, p_light.nodes));
	r_bindings.push_back(PassBinding::read(COUNT_BINDING_CUT_FACES, p_light.cut_faces));
	r_bindings.push_back(PassBinding::read(COUNT_BINDING_TOTALS, p_light.totals));
}

/// The bindings of passes that count solids, see count_solids_inc.glsl.
std::vector<PassBinding> make_solid_bindings(
		const CountLeafPasses &p_passes, const CountLeaves &p_leaves) {
	std::vector<PassBinding> bindings = make_kind_bindings(p_leaves);
	bind_light_items(p_passes.light, bindings);
	bindings.push_back(PassBinding::read(COUNT_BINDING_RESULTS, p_leaves.results));
	bindings.push_back(PassBinding::read(COUNT_BINDING_LISTS, p_leaves.lists));
	bindings.push_back(PassBinding::write(
			COUNT_BINDING_STATUS, p_leaves.status, PassBuilder::Content::UPDATE));
	return bindings;
}

/// The bindings of passes that count edges, see count_resolve_inc.glsl.
std::vector<PassBinding> make_count_bindings(
		const CountLeafPasses &p_passes, const CountLeaves &p_leaves, RGBuffer p_masks) {
	std::vector<PassBinding> bindings = make_solid_bindings(p_passes, p_leaves);
	bindings.push_back(PassBinding::read(COUNT_BINDING_MASKS, p_masks));
	return bindings;
}

CountShape get_shape(const CountLeafPasses &p_passes) {
	return get_count_shape(p_passes.inputs.device, p_passes.settings.get_sample_set_count());
}

/// The specialization constants of every shader that processes leaves. p_group_size,
/// p_sample_set_count: of passes that count edges.
std::vector<SpecializationConstant> make_pipeline_constants(const CountLeafPasses &p_passes,
		uint32_t p_group_size = 1, uint32_t p_sample_set_count = 1) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	return { { EDGE_COUNT_CONSTANT_SUBGROUP_SIZE, inputs.device.get_features().subgroup_size },
		{ EDGE_COUNT_CONSTANT_SAMPLE_SETS, p_sample_set_count },
		{ EDGE_COUNT_CONSTANT_IS_DIRECTIONAL, inputs.views.front().is_orthographic ? 1u : 0u },
		{ EDGE_COUNT_CONSTANT_GROUP_SIZE, p_group_size },
		{ EDGE_COUNT_CONSTANT_IS_CPU, inputs.device.get_features().runs_on_cpu ? 1u : 0u },
		{ EDGE_COUNT_CONSTANT_MAY_CUT_DISC, p_passes.capacities.cut_face_count > 0 ? 1u : 0u },
		{ EDGE_COUNT_CONSTANT_HAS_RUNGS, p_passes.settings.has_time_budget() ? 1u : 0u } };
}

/// Records the dispatches of all chunks of a kind of leaves, see CountLeafPush. Nothing separates
/// them: each leaf is in one of them.
void dispatch_chunks(PassContext &p_context, shader::CountLeafPush p_push, uint32_t p_chunk_count,
		RGBuffer p_arguments, uint32_t p_argument_index) {
	for (uint32_t chunk = 0; chunk < p_chunk_count; ++chunk) {
		p_push.chunk = chunk;
		p_context.commands.push_constants(p_push);
		p_context.commands.dispatch_indirect(p_context.get(p_arguments),
				EDGE_COUNT_ARGUMENT_WORDS * p_argument_index * sizeof(uint32_t));
	}
}

/// Leaves that one pass resolves, and how.
struct KindPass {
	std::string name;
	std::string shader;
	uint32_t kind = 0;	  // EDGE_COUNT_LEAVES_*
	uint32_t rungs = ~0u; // bit i: those on rung i
	// If edges are counted: how many of a leaf's 64 receivers are, and with how many sets of
	// points.
	uint32_t receiver_count = EDGE_COUNT_BLOCK_PIXELS;
	uint32_t sample_set_count = 1;
	float nearest_w = 0; // of the filter, see CountLeafPush
};

/// A pass that counts edges.
struct CountingPass {
	const char *name;
	const char *shader;
	uint32_t kind; // EDGE_COUNT_LEAVES_*
	uint32_t point_count;
	uint32_t rungs = ~0u; // see KindPass
	uint32_t receiver_count = EDGE_COUNT_BLOCK_PIXELS;
	bool may_be_unfinished = false; // some subgroups may have edges left for rounds
	bool has_few_points = false;	// fewer than the light
};

std::vector<CountingPass> list_counting_passes(const CountSettings &p_settings) {
	const uint32_t few_points = EDGE_COUNT_SAMPLE_COUNT;
	const uint32_t points = p_settings.sample_count;
	// Without a time budget all leaves are on the first rung. A light with few points has no second
	// one, so that the first is also what the ladder calls the second.
	const uint32_t few_points_rung = 1u << EDGE_COUNT_RUNG_FEW_POINTS;
	const uint32_t few_pixels_rung = 1u << EDGE_COUNT_RUNG_FEW_PIXELS;
	const bool is_lowered = p_settings.has_time_budget() && points > few_points;
	const uint32_t full = 1u << EDGE_COUNT_RUNG_FULL | (is_lowered ? 0 : few_points_rung);
	std::vector<CountingPass> passes = {
		{ "resolve smooth", "shadow_edge_count/resolve_few_pixels.comp", EDGE_COUNT_LEAVES_SMOOTH,
				points, is_lowered ? full : full | few_pixels_rung, EDGE_COUNT_FEW_PIXELS },
		{ "resolve", "shadow_edge_count/resolve.comp", EDGE_COUNT_LEAVES_LISTED, points, full,
				EDGE_COUNT_BLOCK_PIXELS,
				/*may_be_unfinished=*/true },
		{ "resolve without lists", "shadow_edge_count/resolve.comp", EDGE_COUNT_LEAVES_UNLISTED,
				points, full, EDGE_COUNT_BLOCK_PIXELS, /*may_be_unfinished=*/true },
	};
	if (is_lowered) {
		passes.push_back({ "resolve smooth, 64 points", "shadow_edge_count/resolve_few_pixels.comp",
				EDGE_COUNT_LEAVES_SMOOTH, few_points, few_points_rung | few_pixels_rung,
				EDGE_COUNT_FEW_PIXELS,
				/*may_be_unfinished=*/false, /*has_few_points=*/true });
		passes.push_back({ "resolve, 64 points", "shadow_edge_count/resolve.comp",
				EDGE_COUNT_LEAVES_LISTED, few_points, few_points_rung, EDGE_COUNT_BLOCK_PIXELS,
				/*may_be_unfinished=*/true,
				/*has_few_points=*/true });
	}
	if (p_settings.has_time_budget()) {
		passes.push_back({ "resolve, 16 pixels", "shadow_edge_count/resolve_few_pixels.comp",
				EDGE_COUNT_LEAVES_LISTED, few_points, few_pixels_rung, EDGE_COUNT_FEW_PIXELS,
				/*may_be_unfinished=*/false, /*has_few_points=*/is_lowered });
	}
	return passes;
}

/// The index of the arguments of a pass's dispatches: those of one rung if it resolves no other, so
/// that nothing runs if no leaf is on it.
uint32_t find_argument_index(const CountLeafPasses &p_passes, const KindPass &p_kind) {
	const auto rung = static_cast<uint32_t>(std::countr_zero(p_kind.rungs));
	const bool is_one_rung = std::has_single_bit(p_kind.rungs) ||
			(p_kind.kind == EDGE_COUNT_LEAVES_SMOOTH && rung == EDGE_COUNT_RUNG_FEW_POINTS);
	return p_passes.settings.has_time_budget() && is_one_rung
			? EDGE_COUNT_RUNG_ARGUMENTS(rung, p_kind.kind)
			: p_kind.kind;
}

/// Adds indirect dispatches over the leaves of some kinds, with the same bindings.
void add_kind_passes(RenderGraph &r_graph, const CountLeafPasses &p_passes,
		const CountLeaves &p_leaves, std::span<const KindPass> p_kinds,
		std::vector<PassBinding> p_bindings) {
	struct Step {
		PipelineRID pipeline;
		shader::CountLeafPush push;
		uint32_t argument_index;
	};
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	std::vector<Step> steps;
	for (const KindPass &kind : p_kinds) {
		std::vector<SpecializationConstant> constants = make_pipeline_constants(p_passes,
				kind.receiver_count *
						get_count_shape(inputs.device, kind.sample_set_count).lanes_per_receiver,
				kind.sample_set_count);
		const bool has_no_list =
				kind.kind == EDGE_COUNT_LEAVES_UNLISTED || kind.kind == EDGE_COUNT_LEAVES_FILTERED;
		constants.push_back({ EDGE_COUNT_CONSTANT_HAS_NO_LIST, has_no_list ? 1u : 0u });
		constants.push_back(
				{ EDGE_COUNT_CONSTANT_IS_SMOOTH, kind.kind == EDGE_COUNT_LEAVES_SMOOTH ? 1u : 0u });
		steps.push_back({ inputs.device.get_compute_pipeline(
								  { kind.shader, kind.shader, std::move(constants) }),
				{ .kind = kind.kind,
						.first_leaf = kind.kind * p_leaves.leaf_capacity,
						.nearest_w = kind.nearest_w,
						.rungs = kind.rungs },
				find_argument_index(p_passes, kind) });
	}
	PassBuilder pass = r_graph.add_pass(p_kinds.front().name);
	if (p_passes.settings.has_time_budget()) {
		pass.needs_time();
	}
	declare_bindings(pass, p_bindings);
	pass.reads(p_leaves.arguments, Access::INDIRECT_READ);
	pass.execute([=, arguments = p_leaves.arguments, chunk_count = p_leaves.chunk_count,
						 bindings = std::move(p_bindings)](PassContext &p_context) {
		for (const Step &step : steps) {
			bind_compute(p_context, step.pipeline, bindings,
					std::span(reinterpret_cast<const uint8_t *>(&step.push), sizeof(step.push)));
			dispatch_chunks(p_context, step.push, chunk_count, arguments, step.argument_index);
		}
	});
}

/// Adds a pass that counts solids: of leaves without edges, and on GPUs of all, see
/// count_output_inc.glsl.
void add_solids_pass(RenderGraph &r_graph, const CountLeafPasses &p_passes,
		const CountLeaves &p_leaves, RGTexture p_mask) {
	const std::string shader =
			choose_fetching_shader(p_passes.inputs.device, "shadow_edge_count/count_solids.comp");
	std::vector<KindPass> kinds = { { "count solids", shader, EDGE_COUNT_LEAVES_PLAIN } };
	if (!p_passes.inputs.device.get_features().runs_on_cpu) {
		for (const uint32_t kind : { EDGE_COUNT_LEAVES_SMOOTH, EDGE_COUNT_LEAVES_LISTED,
					 EDGE_COUNT_LEAVES_UNLISTED }) {
			kinds.push_back({ "count solids", shader, kind, ~(1u << EDGE_COUNT_RUNG_FILTERED) });
		}
	}
	std::vector<PassBinding> bindings = make_solid_bindings(p_passes, p_leaves);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_kind_passes(r_graph, p_passes, p_leaves, kinds, std::move(bindings));
}

/// Adds the rounds that count what subgroups without iterations left have not counted.
void add_rounds(RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves,
		RGTexture p_mask) {
	std::vector<SpecializationConstant> constants = make_pipeline_constants(
			p_passes, get_shape(p_passes).subgroup_size, p_passes.settings.get_sample_set_count());
	constants.push_back({ EDGE_COUNT_CONSTANT_HAS_NO_LIST, 1u });
	const std::string shader = choose_fetching_shader(
			p_passes.inputs.device, "shadow_edge_count/resolve_unfinished.comp");
	std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_leaves, p_passes.masks);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_rounds_pass(r_graph, p_leaves.rounds,
			p_passes.inputs.device.get_compute_pipeline({ shader, shader, std::move(constants) }),
			bindings);
}

/// Adds a pass that filters leaves with more edges than the budget, or for which there is no time
/// (percentage-closer soft shadows).
void add_filter_pass(RenderGraph &r_graph, const CountLeafPasses &p_passes,
		const CountLeaves &p_leaves, RGTexture p_mask) {
	std::vector<PassBinding> bindings = make_kind_bindings(p_leaves);
	bindings.push_back(PassBinding::read(COUNT_BINDING_DEPTH_MAP, p_passes.depth_map));
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	std::vector<KindPass> kinds;
	const float nearest_w = compute_nearest_w(p_passes.inputs);
	const auto add_kind = [&](uint32_t p_kind, uint32_t p_rungs) {
		kinds.push_back({ .name = "filter",
				.shader = "shadow_edge_count/filter_leaves.comp",
				.kind = p_kind,
				.rungs = p_rungs,
				.nearest_w = nearest_w });
	};
	if (p_passes.settings.has_budget()) {
		add_kind(EDGE_COUNT_LEAVES_FILTERED, ~0u);
	}
	if (p_passes.settings.has_time_budget()) {
		for (const uint32_t kind : { EDGE_COUNT_LEAVES_LISTED, EDGE_COUNT_LEAVES_UNLISTED,
					 EDGE_COUNT_LEAVES_SMOOTH }) {
			add_kind(kind, 1u << EDGE_COUNT_RUNG_FILTERED);
		}
	}
	add_kind_passes(r_graph, p_passes, p_leaves, kinds, std::move(bindings));
}

/// Adds a pass that chooses the rungs of leaves, see EDGE_COUNT_RUNG_FULL.
void add_rungs_pass(
		RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves) {
	// On a CPU measured with leaves.gltf. On GPUs, whose invocations share the points, estimated.
	const float few_points_share =
			p_passes.inputs.device.get_features().runs_on_cpu ? 0.75f : 0.35f;
	const shader::CountRungsPush push = p_passes.settings.get_sample_set_count() > 1
			? shader::CountRungsPush{ p_passes.cost_limit, EDGE_COUNT_RUNG_FULL, few_points_share,
				  /*padding=*/0 }
			: shader::CountRungsPush{ p_passes.cost_limit, EDGE_COUNT_RUNG_FEW_POINTS,
				  /*few_points_share=*/1.0f, /*padding=*/0 };
	const char *shader = "shadow_edge_count/choose_rungs.comp";
	const auto update = PassBuilder::Content::UPDATE;
	add_compute_pass(r_graph, "choose rungs",
			p_passes.inputs.device.get_compute_pipeline({ shader, shader, /*constants=*/{} }),
			{ PassBinding::write(COUNT_BINDING_COUNTS, p_leaves.counts, update),
					PassBinding::write(COUNT_BINDING_STATUS, p_leaves.status, update),
					PassBinding::write(COUNT_BINDING_LADDER, p_passes.ladder, update),
					PassBinding::write(COUNT_BINDING_ARGUMENTS, p_leaves.arguments, update) },
			{ 1, 1, 1 }, make_push_bytes(push));
}

} // namespace

uint32_t choose_list_capacity(glm::uvec2 p_size_px, uint32_t p_item_count) {
	const glm::uvec2 blocks = divide_up(p_size_px, EDGE_COUNT_BLOCK_PX);
	// Rounded to powers of two, so that the memory size seldom changes with the scene.
	const uint64_t words =
			std::min<uint64_t>(std::bit_ceil(std::max(p_item_count, 1u)), LIST_WORDS_PER_BLOCK);
	return static_cast<uint32_t>(
			std::min<uint64_t>(uint64_t(blocks.x) * blocks.y * words, MAX_LIST_WORDS));
}

shader::CountLightConstants make_leaf_constants(const ShadowTechnique::Inputs &p_inputs,
		const CountSettings &p_settings, const CountCapacities &p_capacities,
		uint32_t p_empty_views) {
	shader::CountLightConstants constants = make_count_light_constants(
			p_inputs.views.front(), p_settings.disc_radius, p_inputs.scene.scene_size_m);
	const CountTrees trees = lay_out_trees(p_capacities);
	for (uint32_t level = 0; level < EDGE_COUNT_MAX_LEVELS; ++level) {
		constants.face_levels[level / 4][static_cast<int>(level % 4)] = trees.face_levels[level];
		constants.edge_levels[level / 4][static_cast<int>(level % 4)] = trees.edge_levels[level];
	}
	constants.block_count = divide_up(p_inputs.size_px, EDGE_COUNT_BLOCK_PX);
	constants.empty_views = p_empty_views;
	constants.leaf_capacity =
			(LEAVES_PER_TWO_BLOCKS * constants.block_count.x * constants.block_count.y + 1) / 2;
	constants.list_capacity = choose_list_capacity(
			p_inputs.size_px, p_capacities.edge_count + p_capacities.face_count);
	constants.budget = p_settings.budget;
	constants.face_count = p_capacities.face_count;
	constants.max_edge_count = p_capacities.edge_count;
	constants.max_cut_face_count = p_capacities.cut_face_count;
	constants.interpolation = p_settings.interpolation;
	const CountRoundLimits limits = choose_round_limits(p_inputs.size_px, p_capacities.edge_count,
			get_count_shape(p_inputs.device, p_settings.get_sample_set_count()));
	constants.unfinished_slot_count = limits.slot_count;
	constants.unfinished_round_count = limits.round_count;
	const uint32_t chunk_leaves =
			p_inputs.device.get_features().runs_on_cpu ? CPU_CHUNK_LEAVES : GPU_CHUNK_LEAVES;
	constants.chunk_count = (constants.leaf_capacity + chunk_leaves - 1) / chunk_leaves;
	return constants;
}

CountLeaves add_leaf_passes(RenderGraph &r_graph, const CountLeafPasses &p_passes) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const shader::CountLightConstants constants = make_leaf_constants(
			inputs, p_passes.settings, p_passes.capacities, p_passes.empty_views);
	CountLeaves leaves;
	leaves.receivers = make_map_resolve_bindings(r_graph, inputs);
	leaves.constants = r_graph.upload_constants("counted light", constants);
	leaves.leaf_capacity = constants.leaf_capacity;
	leaves.chunk_count = constants.chunk_count;
	const auto make_buffer = [&](const char *p_name, uint64_t p_count, uint64_t p_item_bytes) {
		return r_graph.create_buffer({ p_name, p_count * p_item_bytes,
				BufferUsage::STORAGE | BufferUsage::COPY_SOURCE });
	};
	leaves.leaves = make_buffer("leaves", constants.leaf_capacity, sizeof(shader::CountLeaf));
	leaves.results =
			make_buffer("leaf results", constants.leaf_capacity, sizeof(shader::CountLeafResult));
	BufferDesc lists = make_fetched_buffer_desc(inputs.device, "leaf lists",
			uint64_t(constants.list_capacity) * sizeof(uint32_t), Format::R32_UINT);
	lists.usage = lists.usage | BufferUsage::COPY_SOURCE;
	leaves.lists = r_graph.create_buffer(lists);
	leaves.rounds = create_rounds_buffers(r_graph, constants, get_shape(p_passes));
	leaves.kinds = make_buffer("leaves by kind",
			uint64_t(EDGE_COUNT_LEAF_KINDS) * constants.leaf_capacity, sizeof(uint32_t));
	const auto make_arguments = [&](const char *p_name, uint64_t p_count) {
		return r_graph.create_buffer(
				{ p_name, p_count * EDGE_COUNT_ARGUMENT_WORDS * sizeof(uint32_t),
						BufferUsage::STORAGE | BufferUsage::INDIRECT | BufferUsage::COPY_TARGET });
	};
	const RGBuffer all_arguments = make_arguments("arguments of all leaves", 1);
	leaves.arguments = make_arguments("arguments of leaves by kind", EDGE_COUNT_ARGUMENT_COUNT);
	leaves.counts =
			r_graph.create_buffer({ "leaf counts", EDGE_COUNT_COUNT_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::COPY_TARGET | BufferUsage::COPY_SOURCE });
	leaves.status =
			r_graph.create_buffer({ "edge count status", EDGE_COUNT_STATUS_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::COPY_TARGET | BufferUsage::COPY_SOURCE });
	std::vector<RGBuffer> cleared = leaves.rounds.list_cleared();
	cleared.insert(
			cleared.end(), { all_arguments, leaves.arguments, leaves.counts, leaves.status });
	PassBuilder clear = r_graph.add_pass("clear leaves");
	for (const RGBuffer &buffer : cleared) {
		clear.writes(buffer, Access::COPY_WRITE);
	}
	clear.execute([cleared](PassContext &p_context) {
		for (const RGBuffer &buffer : cleared) {
			p_context.commands.clear_buffer(p_context.get(buffer));
		}
	});
	const auto get_pipeline = [&](const char *p_shader) {
		const std::string shader = choose_fetching_shader(inputs.device, p_shader);
		return inputs.device.get_compute_pipeline(
				{ shader, shader, make_pipeline_constants(p_passes) });
	};
	std::vector<PassBinding> bindings = leaves.receivers;
	bindings.push_back(PassBinding::constants(COUNT_BINDING_LIGHT, leaves.constants));
	bind_light_items(p_passes.light, bindings);
	std::vector<PassBinding> list_bindings = bindings;
	bindings.push_back(PassBinding::write(COUNT_BINDING_LEAVES, leaves.leaves));
	bindings.push_back(PassBinding::write(
			COUNT_BINDING_ARGUMENTS, all_arguments, PassBuilder::Content::UPDATE));
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_COUNTS, leaves.counts, PassBuilder::Content::UPDATE));
	add_map_resolve_pass(r_graph, "find leaves", get_pipeline("shadow_edge_count/find_leaves.comp"),
			std::move(bindings), inputs);
	list_bindings.push_back(PassBinding::read(COUNT_BINDING_LEAVES, leaves.leaves));
	list_bindings.push_back(PassBinding::write(COUNT_BINDING_RESULTS, leaves.results));
	list_bindings.push_back(PassBinding::write(COUNT_BINDING_LISTS, leaves.lists));
	list_bindings.push_back(PassBinding::write(COUNT_BINDING_KINDS, leaves.kinds));
	list_bindings.push_back(
			PassBinding::write(COUNT_BINDING_STATUS, leaves.status, PassBuilder::Content::UPDATE));
	list_bindings.push_back(PassBinding::write(
			COUNT_BINDING_ARGUMENTS, leaves.arguments, PassBuilder::Content::UPDATE));
	list_bindings.push_back(
			PassBinding::write(COUNT_BINDING_COUNTS, leaves.counts, PassBuilder::Content::UPDATE));
	const PipelineRID list_pipeline = get_pipeline("shadow_edge_count/list_leaves.comp");
	PassBuilder list = r_graph.add_pass("list leaves");
	if (p_passes.settings.has_time_budget()) {
		list.needs_time();
	}
	declare_bindings(list, list_bindings);
	list.reads(all_arguments, Access::INDIRECT_READ);
	list.execute([=, chunk_count = leaves.chunk_count](PassContext &p_context) {
		const shader::CountLeafPush push = {};
		bind_compute(p_context, list_pipeline, list_bindings,
				std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push)));
		dispatch_chunks(p_context, push, chunk_count, all_arguments, /*p_argument_index=*/0);
	});
	if (p_passes.settings.has_time_budget()) {
		add_rungs_pass(r_graph, p_passes, leaves);
	}
	return leaves;
}

RGTexture add_count_passes(
		RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves) {
	const RGTexture mask = create_tiled_mask(r_graph, p_passes.inputs.size_px);
	const PassBinding output =
			PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE);
	const auto add_pass = [&](const KindPass &p_pass, std::vector<PassBinding> p_bindings) {
		p_bindings.push_back(output);
		add_kind_passes(r_graph, p_passes, p_leaves, { &p_pass, 1 }, std::move(p_bindings));
	};
	add_pass({ "resolve dark", "shadow_edge_count/resolve_dark.comp", EDGE_COUNT_LEAVES_DARK },
			make_kind_bindings(p_leaves));
	add_solids_pass(r_graph, p_passes, p_leaves, mask);
	for (const CountingPass &pass : list_counting_passes(p_passes.settings)) {
		std::vector<PassBinding> bindings = make_count_bindings(
				p_passes, p_leaves, pass.has_few_points ? p_passes.few_masks : p_passes.masks);
		if (pass.may_be_unfinished) {
			p_leaves.rounds.bind_queue(bindings);
		}
		add_pass({ .name = pass.name,
						 .shader = choose_fetching_shader(p_passes.inputs.device, pass.shader),
						 .kind = pass.kind,
						 .rungs = pass.rungs,
						 .receiver_count = pass.receiver_count,
						 .sample_set_count = pass.point_count / EDGE_COUNT_SAMPLE_COUNT },
				std::move(bindings));
	}
	add_rounds(r_graph, p_passes, p_leaves, mask);
	if (p_passes.depth_map) {
		add_filter_pass(r_graph, p_passes, p_leaves, mask);
	}
	return mask;
}

RGTexture add_count_debug_pass(
		RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves) {
	const RGTexture output = r_graph.create_texture(
			{ "counted", Format::R16_SFLOAT, p_passes.inputs.size_px, EDGE_COUNT_DEBUG_LAYERS,
					TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE |
							TextureUsage::COPY_TARGET,
					/*is_array=*/true });
	add_clear_pass(r_graph, "clear debug", output, 0.0f); // of leaves that are all lit
	for (uint32_t kind = 0; kind < EDGE_COUNT_LEAF_KINDS; ++kind) {
		std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_leaves, p_passes.masks);
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_OUTPUT, output, PassBuilder::Content::UPDATE));
		const KindPass pass = { text("debug ", kind),
			choose_fetching_shader(p_passes.inputs.device, "shadow_edge_count/debug.comp"), kind };
		add_kind_passes(r_graph, p_passes, p_leaves, { &pass, 1 }, std::move(bindings));
	}
	return output;
}

} // namespace gnomon
