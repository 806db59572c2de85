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
constexpr uint64_t WORDS_PER_BLOCK = 2048;
constexpr uint64_t MAX_LIST_WORDS = 5'700'000;
// Every block of pixels has room for one leaf, and half of them for a second one. More are in few
// blocks, and those whose leaves are completely lit need none.
constexpr uint32_t LEAVES_PER_TWO_BLOCKS = 3;

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
		const CountLeafPasses &p_passes, const CountLeaves &p_leaves) {
	std::vector<PassBinding> bindings = make_solid_bindings(p_passes, p_leaves);
	bindings.push_back(PassBinding::read(COUNT_BINDING_MASKS, p_passes.masks));
	return bindings;
}

CountShape get_shape(const CountLeafPasses &p_passes) {
	return get_count_shape(p_passes.inputs.device, p_passes.settings.get_sample_set_count());
}

/// The specialization constants of every shader that processes leaves. p_group_size: of passes that
/// count edges.
std::vector<SpecializationConstant> make_pipeline_constants(
		const CountLeafPasses &p_passes, uint32_t p_group_size = 1) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	return { { EDGE_COUNT_CONSTANT_SUBGROUP_SIZE, inputs.device.get_features().subgroup_size },
		{ EDGE_COUNT_CONSTANT_IS_DIRECTIONAL, inputs.views.front().is_orthographic ? 1u : 0u },
		{ EDGE_COUNT_CONSTANT_GROUP_SIZE, p_group_size },
		{ EDGE_COUNT_CONSTANT_IS_CPU, inputs.device.get_features().runs_on_cpu ? 1u : 0u },
		{ EDGE_COUNT_CONSTANT_MAY_CUT_DISC, p_passes.capacities.cut_face_count > 0 ? 1u : 0u } };
}

/// Adds an indirect dispatch over the leaves of one kind.
void add_kind_pass(RenderGraph &r_graph, const CountLeafPasses &p_passes,
		const CountLeaves &p_leaves, const std::string &p_name, const std::string &p_shader,
		uint32_t p_kind, std::vector<PassBinding> p_bindings) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const shader::CountLeafPush push = { p_kind, p_kind * p_leaves.leaf_capacity,
		p_kind == EDGE_COUNT_LEAVES_FILTERED ? compute_nearest_w(inputs) : 0.0f, /*round=*/0 };
	const uint32_t receiver_count = p_kind == EDGE_COUNT_LEAVES_SMOOTH
			? EDGE_COUNT_SMOOTH_PIXELS
			: EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCK_PX;
	std::vector<SpecializationConstant> constants = make_pipeline_constants(
			p_passes, receiver_count * get_shape(p_passes).lanes_per_receiver);
	const bool has_no_list =
			p_kind == EDGE_COUNT_LEAVES_UNLISTED || p_kind == EDGE_COUNT_LEAVES_FILTERED;
	constants.push_back({ EDGE_COUNT_CONSTANT_HAS_NO_LIST, has_no_list ? 1u : 0u });
	const PipelineRID pipeline =
			inputs.device.get_compute_pipeline({ p_shader, p_shader, std::move(constants) });
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, p_bindings);
	pass.reads(p_leaves.arguments, Access::INDIRECT_READ);
	pass.execute([=, arguments = p_leaves.arguments, bindings = std::move(p_bindings)](
						 PassContext &p_context) {
		bind_compute(p_context, pipeline, bindings,
				std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push)));
		p_context.commands.dispatch_indirect(
				p_context.get(arguments), EDGE_COUNT_ARGUMENT_WORDS * p_kind * sizeof(uint32_t));
	});
}

/// Adds the rounds that count what subgroups without iterations left have not counted.
void add_rounds(RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves,
		RGTexture p_mask) {
	std::vector<SpecializationConstant> constants =
			make_pipeline_constants(p_passes, get_shape(p_passes).subgroup_size);
	constants.push_back({ EDGE_COUNT_CONSTANT_HAS_NO_LIST, 1u });
	const bool is_fine = p_passes.settings.get_sample_set_count() > 1;
	const std::string shader = choose_fetching_shader(p_passes.inputs.device,
			is_fine ? "shadow_edge_count/resolve_unfinished_fine.comp"
					: "shadow_edge_count/resolve_unfinished.comp");
	std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_leaves);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_rounds_pass(r_graph, p_leaves.rounds,
			p_passes.inputs.device.get_compute_pipeline({ shader, shader, std::move(constants) }),
			bindings);
}

/// Adds a pass that filters leaves with more edges than the budget (percentage-closer soft
/// shadows).
void add_filter_pass(RenderGraph &r_graph, const CountLeafPasses &p_passes,
		const CountLeaves &p_leaves, RGTexture p_mask) {
	std::vector<PassBinding> bindings = make_kind_bindings(p_leaves);
	bindings.push_back(PassBinding::read(COUNT_BINDING_DEPTH_MAP, p_passes.depth_map));
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_leaves, "filter", "shadow_edge_count/filter_leaves.comp",
			EDGE_COUNT_LEAVES_FILTERED, std::move(bindings));
}

} // namespace

uint32_t choose_list_capacity(glm::uvec2 p_size_px, uint32_t p_item_count) {
	const glm::uvec2 blocks = divide_up(p_size_px, EDGE_COUNT_BLOCK_PX);
	// Rounded to powers of two, so that the memory size seldom changes with the scene.
	const uint64_t words =
			std::min<uint64_t>(std::bit_ceil(std::max(p_item_count, 1u)), WORDS_PER_BLOCK);
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
	const auto make_buffer = [&](const char *p_name, uint64_t p_count, uint64_t p_item_bytes) {
		return r_graph.create_buffer({ p_name, p_count * p_item_bytes, BufferUsage::STORAGE });
	};
	leaves.leaves = make_buffer("leaves", constants.leaf_capacity, sizeof(shader::CountLeaf));
	leaves.results =
			make_buffer("leaf results", constants.leaf_capacity, sizeof(shader::CountLeafResult));
	leaves.lists = r_graph.create_buffer(make_fetched_buffer_desc(inputs.device, "leaf lists",
			uint64_t(constants.list_capacity) * sizeof(uint32_t), Format::R32_UINT));
	leaves.rounds = create_rounds_buffers(r_graph, constants, get_shape(p_passes));
	leaves.kinds = make_buffer("leaves by kind",
			uint64_t(EDGE_COUNT_LEAF_KINDS) * constants.leaf_capacity, sizeof(uint32_t));
	const auto make_arguments = [&](const char *p_name, uint64_t p_count) {
		return r_graph.create_buffer(
				{ p_name, p_count * EDGE_COUNT_ARGUMENT_WORDS * sizeof(uint32_t),
						BufferUsage::STORAGE | BufferUsage::INDIRECT | BufferUsage::COPY_TARGET });
	};
	const RGBuffer all_arguments = make_arguments("arguments of all leaves", 1);
	leaves.arguments = make_arguments("arguments of leaves by kind", EDGE_COUNT_LEAF_KINDS);
	leaves.counts =
			r_graph.create_buffer({ "leaf counts", EDGE_COUNT_COUNT_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::COPY_TARGET });
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
	add_compute_steps(r_graph, "list leaves",
			{ { .pipeline = get_pipeline("shadow_edge_count/list_leaves.comp"),
					.bindings = std::move(list_bindings),
					.arguments = all_arguments } });
	return leaves;
}

RGTexture add_count_passes(
		RenderGraph &r_graph, const CountLeafPasses &p_passes, const CountLeaves &p_leaves) {
	const auto choose = [&](const char *p_shader) {
		return choose_fetching_shader(p_passes.inputs.device, p_shader);
	};
	const RGTexture mask = create_tiled_mask(r_graph, p_passes.inputs.size_px);
	std::vector<PassBinding> bindings = make_kind_bindings(p_leaves);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_leaves, "resolve dark",
			"shadow_edge_count/resolve_dark.comp", EDGE_COUNT_LEAVES_DARK, std::move(bindings));
	bindings = make_solid_bindings(p_passes, p_leaves);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_leaves, "resolve plain",
			choose("shadow_edge_count/resolve_plain.comp"), EDGE_COUNT_LEAVES_PLAIN,
			std::move(bindings));
	const bool is_fine = p_passes.settings.get_sample_set_count() > 1;
	const char *resolve =
			is_fine ? "shadow_edge_count/resolve_fine.comp" : "shadow_edge_count/resolve.comp";
	const char *resolve_smooth = is_fine ? "shadow_edge_count/resolve_smooth_fine.comp"
										 : "shadow_edge_count/resolve_smooth.comp";
	for (const auto &[kind, name, shader] :
			{ std::tuple(EDGE_COUNT_LEAVES_SMOOTH, "resolve smooth", resolve_smooth),
					std::tuple(EDGE_COUNT_LEAVES_LISTED, "resolve", resolve),
					std::tuple(EDGE_COUNT_LEAVES_UNLISTED, "resolve without lists", resolve) }) {
		bindings = make_count_bindings(p_passes, p_leaves);
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
		if (kind != EDGE_COUNT_LEAVES_SMOOTH) {
			p_leaves.rounds.bind_queue(bindings);
		}
		add_kind_pass(r_graph, p_passes, p_leaves, name, choose(shader), kind, std::move(bindings));
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
		std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_leaves);
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_OUTPUT, output, PassBuilder::Content::UPDATE));
		add_kind_pass(r_graph, p_passes, p_leaves, text("debug ", kind),
				choose_fetching_shader(p_passes.inputs.device, "shadow_edge_count/debug.comp"),
				kind, std::move(bindings));
	}
	return output;
}

} // namespace gnomon
