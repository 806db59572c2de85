#include "modules/shadow_edge_count/block_passes.h"

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

// Capacity of all edge lists together: an average per block, and at most 24 MB at 4 bytes per edge.
// Blocks whose lists do not fit take more time, but are still exact.
constexpr uint64_t LISTED_EDGES_PER_BLOCK = 2048;
constexpr uint64_t MAX_LISTED_EDGES = 6'000'000;

glm::uvec2 divide_up(glm::uvec2 p_value, uint32_t p_divisor) {
	return (p_value + (p_divisor - 1)) / p_divisor;
}

/// The bindings of every pass over blocks, see count_blocks_inc.glsl.
std::vector<PassBinding> make_block_bindings(const CountBlocks &p_blocks) {
	std::vector<PassBinding> bindings = p_blocks.receivers;
	bindings.push_back(PassBinding::constants(COUNT_BINDING_LIGHT, p_blocks.constants));
	bindings.push_back(PassBinding::read(COUNT_BINDING_BLOCKS, p_blocks.blocks));
	return bindings;
}

/// The bindings of passes that read face lists, see count_lists_inc.glsl.
std::vector<PassBinding> make_plain_bindings(
		const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	std::vector<PassBinding> bindings = make_block_bindings(p_blocks);
	bindings.push_back(PassBinding::read(COUNT_BINDING_HEADS, p_passes.light.heads));
	bindings.push_back(PassBinding::read(COUNT_BINDING_NODES, p_passes.light.nodes));
	bindings.push_back(PassBinding::read(COUNT_BINDING_FACES, p_passes.light.faces));
	bindings.push_back(PassBinding::read(COUNT_BINDING_PLANES, p_passes.light.planes));
	bindings.push_back(PassBinding::read(COUNT_BINDING_TOTALS, p_passes.light.totals));
	bindings.push_back(PassBinding::read(COUNT_BINDING_CUT_FACES, p_passes.light.cut_faces));
	bindings.push_back(PassBinding::read(COUNT_BINDING_BLOCK_RECEIVERS, p_blocks.block_receivers));
	bindings.push_back(PassBinding::read(COUNT_BINDING_CHAINS, p_blocks.chains));
	bindings.push_back(PassBinding::write(
			COUNT_BINDING_STATUS, p_blocks.status, PassBuilder::Content::UPDATE));
	return bindings;
}

/// The bindings of passes that count edges, see count_resolve_inc.glsl.
std::vector<PassBinding> make_count_bindings(
		const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	std::vector<PassBinding> bindings = make_plain_bindings(p_passes, p_blocks);
	bindings.push_back(PassBinding::read(COUNT_BINDING_EDGES, p_passes.light.edges));
	bindings.push_back(PassBinding::read(COUNT_BINDING_BUNDLES, p_passes.light.bundles));
	bindings.push_back(PassBinding::read(COUNT_BINDING_LISTS, p_blocks.lists));
	bindings.push_back(PassBinding::read(COUNT_BINDING_MASKS, p_passes.masks));
	return bindings;
}

/// The specialization constants of every shader that processes blocks.
std::vector<SpecializationConstant> make_pipeline_constants(const CountBlockPasses &p_passes) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	return { { EDGE_COUNT_CONSTANT_VIEW_COUNT, static_cast<uint32_t>(inputs.views.size()) },
		{ EDGE_COUNT_CONSTANT_SUBGROUP_SIZE, inputs.device.get_features().subgroup_size },
		{ EDGE_COUNT_CONSTANT_IS_DIRECTIONAL, inputs.views.front().is_orthographic ? 1u : 0u },
		{ EDGE_COUNT_CONSTANT_GROUP_SIZE, get_count_subgroup_size(inputs.device) },
		{ EDGE_COUNT_CONSTANT_MAY_CUT_DISC, p_passes.capacities.cut_face_count > 0 ? 1u : 0u } };
}

/// Adds an indirect dispatch over the blocks of one kind.
void add_kind_pass(RenderGraph &r_graph, const CountBlockPasses &p_passes,
		const CountBlocks &p_blocks, const std::string &p_name, const std::string &p_shader,
		uint32_t p_kind, std::vector<PassBinding> p_bindings) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const shader::CountBlockPush push = { p_kind, p_kind * p_blocks.block_count,
		p_kind == EDGE_COUNT_BLOCKS_FILTERED ? compute_nearest_w(inputs) : 0.0f, /*round=*/0 };
	std::vector<SpecializationConstant> constants = make_pipeline_constants(p_passes);
	const bool has_no_list =
			p_kind == EDGE_COUNT_BLOCKS_UNLISTED || p_kind == EDGE_COUNT_BLOCKS_FILTERED;
	constants.push_back({ EDGE_COUNT_CONSTANT_HAS_NO_LIST, has_no_list ? 1u : 0u });
	const PipelineRID pipeline =
			inputs.device.get_compute_pipeline({ p_shader, p_shader, std::move(constants) });
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, p_bindings);
	pass.reads(p_blocks.dispatches, Access::INDIRECT_READ);
	pass.execute([=, dispatches = p_blocks.dispatches, bindings = std::move(p_bindings)](
						 PassContext &p_context) {
		bind_compute(p_context, pipeline, bindings,
				std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push)));
		p_context.commands.dispatch_indirect(
				p_context.get(dispatches), 3 * p_kind * sizeof(uint32_t));
	});
}

/// Adds the rounds that count what subgroups without iterations left have not counted.
void add_rounds(RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks,
		RGTexture p_mask) {
	std::vector<SpecializationConstant> constants = make_pipeline_constants(p_passes);
	constants.push_back({ EDGE_COUNT_CONSTANT_HAS_NO_LIST, 1u });
	const bool is_fine = p_passes.settings.get_sample_set_count() > 1;
	const std::string shader = choose_fetching_shader(p_passes.inputs.device,
			is_fine ? "shadow_edge_count/resolve_unfinished_fine.comp"
					: "shadow_edge_count/resolve_unfinished.comp");
	std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_blocks);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_rounds_pass(r_graph, p_blocks.rounds,
			p_passes.inputs.device.get_compute_pipeline({ shader, shader, std::move(constants) }),
			bindings);
}

/// Adds a pass that filters blocks with more edges than the budget (percentage-closer soft
/// shadows).
void add_filter_pass(RenderGraph &r_graph, const CountBlockPasses &p_passes,
		const CountBlocks &p_blocks, RGTexture p_mask) {
	CountBlocks blocks = p_blocks;
	// The views of the depth map, whose size differs from that of the maps of face lists.
	blocks.receivers = make_map_resolve_bindings(
			r_graph, p_passes.inputs, p_passes.inputs.light, p_passes.depth_views);
	std::vector<PassBinding> bindings = make_block_bindings(blocks);
	bindings.push_back(PassBinding::read(COUNT_BINDING_DEPTH_MAP, p_passes.depth_map));
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, blocks, "filter", "shadow_edge_count/filter_blocks.comp",
			EDGE_COUNT_BLOCKS_FILTERED, std::move(bindings));
}

} // namespace

uint32_t choose_chunk_capacity(glm::uvec2 p_size_px, uint32_t p_edge_count) {
	const glm::uvec2 blocks = divide_up(p_size_px, EDGE_COUNT_BLOCK_PX);
	// Rounded to powers of two, so that the memory size seldom changes with the scene.
	const uint64_t edges = std::min<uint64_t>(std::bit_ceil(p_edge_count), LISTED_EDGES_PER_BLOCK);
	const uint64_t chunks_per_block = std::max<uint64_t>(edges / EDGE_COUNT_CHUNK_SIZE, 1);
	return static_cast<uint32_t>(
			std::min<uint64_t>(uint64_t(blocks.x) * blocks.y * chunks_per_block,
					MAX_LISTED_EDGES / EDGE_COUNT_CHUNK_SIZE));
}

shader::CountLightConstants make_block_constants(const ShadowTechnique::Inputs &p_inputs,
		const CountSettings &p_settings, const CountCapacities &p_capacities,
		uint32_t p_empty_views) {
	shader::CountLightConstants constants =
			make_count_light_constants({ p_inputs.views.begin(), p_inputs.views.end() },
					p_settings.disc_radius, p_inputs.scene.scene_size_m);
	constants.block_count = divide_up(p_inputs.size_px, EDGE_COUNT_BLOCK_PX);
	constants.empty_views = p_empty_views;
	constants.chunk_capacity = choose_chunk_capacity(p_inputs.size_px, p_capacities.edge_count);
	constants.budget = p_settings.budget;
	constants.node_capacity = p_capacities.nodes_per_view;
	constants.face_count = p_capacities.face_count;
	constants.max_cut_face_count = p_capacities.cut_face_count;
	constants.interpolation = p_settings.interpolation;
	constants.max_bundle_count = p_capacities.get_bundle_count();
	const CountRoundLimits limits =
			choose_round_limits(p_inputs.size_px, constants.view_count, p_capacities.edge_count,
					get_count_subgroup_size(p_inputs.device), p_settings.get_sample_set_count());
	constants.unfinished_slot_count = limits.slot_count;
	constants.unfinished_round_count = limits.round_count;
	constants.max_edge_count = p_settings.disc_radius > 0 ? p_capacities.edge_count : 0;
	return constants;
}

CountBlocks add_block_passes(RenderGraph &r_graph, const CountBlockPasses &p_passes) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const shader::CountLightConstants constants = make_block_constants(
			inputs, p_passes.settings, p_passes.capacities, p_passes.empty_views);
	const uint64_t block_count = uint64_t(constants.block_count.x) * constants.block_count.y;
	const uint32_t part_count = EDGE_COUNT_PARTS(constants.view_count);
	CountBlocks blocks;
	blocks.receivers = make_map_resolve_bindings(r_graph, inputs);
	blocks.constants = r_graph.upload_constants("counted light", constants);
	const RGBuffer boxes = r_graph.create_buffer({ "receiver boxes",
			block_count * part_count * sizeof(shader::CountBlockBox), BufferUsage::STORAGE });
	const auto make_words = [&](const char *p_name, uint64_t p_count) {
		return r_graph.create_buffer({ p_name, p_count * sizeof(uint32_t), BufferUsage::STORAGE });
	};
	blocks.block_receivers =
			make_words("block receivers", block_count * EDGE_COUNT_RECEIVERS_WORDS);
	blocks.chains = make_words("block chains", block_count * part_count * EDGE_COUNT_CHAIN_WORDS);
	// + 1: the index of each chunk's next chunk.
	blocks.lists = r_graph.create_buffer(make_fetched_buffer_desc(inputs.device, "block edges",
			uint64_t(constants.chunk_capacity) * (EDGE_COUNT_CHUNK_SIZE + 1) * sizeof(uint32_t),
			Format::R32_UINT));
	blocks.block_count = static_cast<uint32_t>(block_count);
	blocks.rounds = create_rounds_buffers(
			r_graph, inputs.device, constants, p_passes.settings.get_sample_set_count());
	blocks.blocks = make_words("blocks by kind", EDGE_COUNT_BLOCK_KINDS * block_count);
	blocks.dispatches = r_graph.create_buffer(
			{ "block dispatches", EDGE_COUNT_DISPATCH_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::INDIRECT | BufferUsage::COPY_TARGET });
	blocks.status =
			r_graph.create_buffer({ "edge count status", EDGE_COUNT_STATUS_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::COPY_TARGET | BufferUsage::COPY_SOURCE });
	std::vector<RGBuffer> cleared = blocks.rounds.list_cleared();
	cleared.push_back(blocks.dispatches);
	cleared.push_back(blocks.status);
	PassBuilder clear = r_graph.add_pass("clear blocks");
	for (const RGBuffer &buffer : cleared) {
		clear.writes(buffer, Access::COPY_WRITE);
	}
	clear.execute([cleared](PassContext &p_context) {
		for (const RGBuffer &buffer : cleared) {
			p_context.commands.clear_buffer(p_context.get(buffer));
		}
	});
	const auto get_pipeline = [&](const std::string &p_shader) {
		return inputs.device.get_compute_pipeline(
				{ p_shader, p_shader, make_pipeline_constants(p_passes) });
	};
	std::vector<PassBinding> bindings = blocks.receivers;
	bindings.push_back(PassBinding::constants(COUNT_BINDING_LIGHT, blocks.constants));
	bindings.push_back(PassBinding::write(COUNT_BINDING_BOXES, boxes));
	bindings.push_back(PassBinding::write(COUNT_BINDING_BLOCK_RECEIVERS, blocks.block_receivers));
	bindings.push_back(PassBinding::write(COUNT_BINDING_CHAINS, blocks.chains));
	add_map_resolve_pass(r_graph, "receiver boxes",
			get_pipeline("shadow_edge_count/receiver_boxes.comp"), std::move(bindings), inputs);
	const CountFrameBuffers &light = p_passes.light;
	static_assert(EDGE_COUNT_BLOCK_PX * EDGE_COUNT_BLOCKS_PER_TILE_SIDE == LIT_TILE_PX);
	add_tile_pass(r_graph, "list blocks",
			get_pipeline(
					choose_fetching_shader(inputs.device, "shadow_edge_count/list_blocks.comp")),
			{ PassBinding::constants(COUNT_BINDING_LIGHT, blocks.constants),
					PassBinding::read(COUNT_BINDING_BOXES, boxes),
					PassBinding::read(COUNT_BINDING_BLOCK_RECEIVERS, blocks.block_receivers),
					PassBinding::read(COUNT_BINDING_EDGES, light.edges),
					PassBinding::read(COUNT_BINDING_BUNDLES, light.bundles),
					PassBinding::read(COUNT_BINDING_HEADS, light.heads),
					PassBinding::read(COUNT_BINDING_NODES, light.nodes),
					PassBinding::read(COUNT_BINDING_FACES, light.faces),
					PassBinding::read(COUNT_BINDING_PLANES, light.planes),
					PassBinding::read(COUNT_BINDING_TOTALS, light.totals),
					PassBinding::read(COUNT_BINDING_CUT_FACES, light.cut_faces),
					PassBinding::write(
							COUNT_BINDING_CHAINS, blocks.chains, PassBuilder::Content::UPDATE),
					PassBinding::write(COUNT_BINDING_LISTS, blocks.lists),
					PassBinding::write(COUNT_BINDING_BLOCKS, blocks.blocks),
					PassBinding::write(
							COUNT_BINDING_STATUS, blocks.status, PassBuilder::Content::UPDATE),
					PassBinding::write(COUNT_BINDING_DISPATCHES, blocks.dispatches,
							PassBuilder::Content::UPDATE) },
			inputs.tiles, MAP_RESOLVE_BINDING_TILES, /*p_push=*/{}, TileDispatch::TILES);
	return blocks;
}

RGTexture add_count_passes(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	const auto choose = [&](const char *p_shader) {
		return choose_fetching_shader(p_passes.inputs.device, p_shader);
	};
	const RGTexture mask = create_tiled_mask(r_graph, p_passes.inputs.size_px);
	std::vector<PassBinding> bindings = make_block_bindings(p_blocks);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_blocks, "resolve dark",
			"shadow_edge_count/resolve_dark.comp", EDGE_COUNT_BLOCKS_DARK, std::move(bindings));
	bindings = make_plain_bindings(p_passes, p_blocks);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_blocks, "resolve plain",
			choose("shadow_edge_count/resolve_plain.comp"), EDGE_COUNT_BLOCKS_PLAIN,
			std::move(bindings));
	const bool is_fine = p_passes.settings.get_sample_set_count() > 1;
	const char *resolve =
			is_fine ? "shadow_edge_count/resolve_fine.comp" : "shadow_edge_count/resolve.comp";
	const char *resolve_smooth = is_fine ? "shadow_edge_count/resolve_smooth_fine.comp"
										 : "shadow_edge_count/resolve_smooth.comp";
	for (const auto &[kind, name, shader] :
			{ std::tuple(EDGE_COUNT_BLOCKS_SMOOTH, "resolve smooth", resolve_smooth),
					std::tuple(EDGE_COUNT_BLOCKS_LISTED, "resolve", resolve),
					std::tuple(EDGE_COUNT_BLOCKS_UNLISTED, "resolve without lists", resolve) }) {
		bindings = make_count_bindings(p_passes, p_blocks);
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
		if (kind != EDGE_COUNT_BLOCKS_SMOOTH) {
			p_blocks.rounds.bind_queue(bindings);
		}
		add_kind_pass(r_graph, p_passes, p_blocks, name, choose(shader), kind, std::move(bindings));
	}
	add_rounds(r_graph, p_passes, p_blocks, mask);
	if (p_passes.depth_map) {
		add_filter_pass(r_graph, p_passes, p_blocks, mask);
	}
	return mask;
}

RGTexture add_count_debug_pass(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	const RGTexture output = r_graph.create_texture(
			{ "counted", Format::R16_SFLOAT, p_passes.inputs.size_px, EDGE_COUNT_DEBUG_LAYERS,
					TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE |
							TextureUsage::COPY_TARGET,
					/*is_array=*/true });
	add_clear_pass(r_graph, "clear debug", output, 0.0f); // of blocks that are all lit
	for (uint32_t kind = 0; kind < EDGE_COUNT_BLOCK_KINDS; ++kind) {
		std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_blocks);
		bindings.push_back(
				PassBinding::write(COUNT_BINDING_OUTPUT, output, PassBuilder::Content::UPDATE));
		add_kind_pass(r_graph, p_passes, p_blocks, text("debug ", kind),
				choose_fetching_shader(p_passes.inputs.device, "shadow_edge_count/debug.comp"),
				kind, std::move(bindings));
	}
	return output;
}

} // namespace gnomon
