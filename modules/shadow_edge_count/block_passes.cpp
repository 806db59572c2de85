#include "modules/shadow_edge_count/block_passes.h"

#include "modules/core/error.h"
#include "modules/renderer/map_resolve.h"
#include "modules/renderer/nearest_caster.h"

#include <algorithm>
#include <bit>

namespace gnomon {

namespace {

constexpr uint64_t MOST_LIST_BYTES = 34'000'000;
constexpr uint32_t SMALLEST_SIDE = 2; // groups: blocks of 16 x 16 pixels

glm::uvec2 divide_up(glm::uvec2 p_value, uint32_t p_divisor) {
	return (p_value + (p_divisor - 1)) / p_divisor;
}

shader::CountLightConstants make_light_constants(const CountBlockPasses &p_passes) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	shader::CountLightConstants constants = {};
	for (uint32_t view = 0; view < inputs.views.size(); ++view) {
		constants.views[view] = make_count_view_constants(inputs.views[view],
				make_count_space(inputs.views[view], p_passes.settings.disc_radius,
						inputs.scene.scene_size_m),
				view);
	}
	constants.group_count = divide_up(inputs.size_px, EDGE_COUNT_GROUP_PX);
	constants.groups_per_block_side =
			choose_groups_per_block_side(inputs.size_px, p_passes.settings.budget);
	constants.block_count = divide_up(constants.group_count, constants.groups_per_block_side);
	constants.view_count = static_cast<uint32_t>(inputs.views.size());
	constants.empty_views = p_passes.empty_views;
	constants.record_capacity = p_passes.capacities.records_per_view;
	constants.fragment_capacity = p_passes.capacities.fragments_per_view;
	constants.list_capacity = p_passes.settings.budget;
	constants.bundle_capacity = p_passes.capacities.get_bundles_per_view();
	return constants;
}

/// What every pass over blocks reads, count_blocks_inc.glsl.
std::vector<PassBinding> make_block_bindings(const CountBlocks &p_blocks) {
	std::vector<PassBinding> bindings = p_blocks.receivers;
	bindings.push_back(PassBinding::constants(COUNT_BINDING_LIGHT, p_blocks.constants));
	bindings.push_back(PassBinding::read(COUNT_BINDING_BLOCKS, p_blocks.blocks));
	return bindings;
}

/// And the layer map, count_map_inc.glsl.
std::vector<PassBinding> make_plain_bindings(
		const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	std::vector<PassBinding> bindings = make_block_bindings(p_blocks);
	bindings.push_back(PassBinding::read(COUNT_BINDING_TEXELS, p_passes.light.texels));
	bindings.push_back(PassBinding::read(COUNT_BINDING_FRAGMENTS, p_passes.light.fragments));
	return bindings;
}

/// And what count_resolve_inc.glsl reads.
std::vector<PassBinding> make_count_bindings(
		const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	std::vector<PassBinding> bindings = make_plain_bindings(p_passes, p_blocks);
	bindings.push_back(PassBinding::read(COUNT_BINDING_RECORDS, p_passes.light.records));
	bindings.push_back(PassBinding::read(COUNT_BINDING_ENDS, p_blocks.ends));
	bindings.push_back(PassBinding::read(COUNT_BINDING_LISTS, p_blocks.lists));
	bindings.push_back(PassBinding::read(COUNT_BINDING_MASKS, p_passes.masks));
	return bindings;
}

/// A compute pass of as many work groups as a place in the dispatches says.
void add_indirect_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, RGBuffer p_dispatches, uint32_t p_place,
		std::vector<uint8_t> p_push) {
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, p_bindings);
	pass.reads(p_dispatches, Access::INDIRECT_READ);
	pass.execute([=, bindings = std::move(p_bindings), push = std::move(p_push)](
						 PassContext &p_context) {
		bind_compute(p_context, p_pipeline, bindings, push);
		p_context.commands.dispatch_indirect(
				p_context.get(p_dispatches), p_place * sizeof(uint32_t));
	});
}

/// A pass over the blocks of one kind.
void add_kind_pass(RenderGraph &r_graph, const CountBlockPasses &p_passes,
		const CountBlocks &p_blocks, const std::string &p_name, const char *p_shader,
		uint32_t p_kind, std::vector<PassBinding> p_bindings) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const bool is_filter = p_kind == EDGE_COUNT_BLOCKS_FILTERED;
	const shader::CountBlockPush push = { p_kind, p_kind * p_blocks.block_count,
		is_filter ? compute_nearest_w(inputs) : 0.0f, 0 };
	const auto *bytes = reinterpret_cast<const uint8_t *>(&push);
	const PipelineRID pipeline = inputs.device.get_compute_pipeline({ p_shader, p_shader,
			{ { EDGE_COUNT_CONSTANT_VIEW_COUNT, static_cast<uint32_t>(inputs.views.size()) } } });
	add_indirect_pass(r_graph, p_name, pipeline, std::move(p_bindings), p_blocks.dispatches,
			3 * p_kind, std::vector<uint8_t>(bytes, bytes + sizeof(push)));
}

/// In blocks that have too many edges: percentage-closer soft shadows from the nearest layer.
void add_filter_passes(RenderGraph &r_graph, const CountBlockPasses &p_passes,
		const CountBlocks &p_blocks, RGTexture p_mask) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const RGTexture map =
			r_graph.create_texture({ "filter map", Format::R32_SFLOAT, inputs.views[0].size_px,
					std::max(2u, static_cast<uint32_t>(inputs.views.size())), // an array
					TextureUsage::STORAGE | TextureUsage::SAMPLED });
	const char *map_shader = "shadow_edge_count/filter_map.comp";
	add_indirect_pass(r_graph, "filter map",
			inputs.device.get_compute_pipeline({ map_shader, map_shader, {} }),
			{ p_blocks.receivers[MAP_RESOLVE_BINDING_VIEWS],
					PassBinding::read(COUNT_BINDING_TEXELS, p_passes.light.texels),
					PassBinding::read(COUNT_BINDING_FRAGMENTS, p_passes.light.fragments),
					PassBinding::write(COUNT_BINDING_OUTPUT, map) },
			p_blocks.dispatches, EDGE_COUNT_DISPATCH_MAP, {});
	std::vector<PassBinding> bindings = make_block_bindings(p_blocks);
	bindings.push_back(PassBinding::read(COUNT_BINDING_MAP, map));
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, p_mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_blocks, "filter", "shadow_edge_count/filter_blocks.comp",
			EDGE_COUNT_BLOCKS_FILTERED, std::move(bindings));
}

} // namespace

uint32_t choose_groups_per_block_side(glm::uvec2 p_size_px, uint32_t p_budget) {
	const glm::uvec2 groups = divide_up(p_size_px, EDGE_COUNT_GROUP_PX);
	uint32_t side = SMALLEST_SIDE;
	const auto compute_bytes = [&] {
		const glm::uvec2 blocks = divide_up(groups, side);
		return uint64_t(blocks.x) * blocks.y * p_budget * sizeof(uint32_t);
	};
	while (compute_bytes() > MOST_LIST_BYTES && side < std::max(groups.x, groups.y)) {
		side *= 2;
	}
	return side;
}

uint32_t choose_budget(glm::uvec2 p_size_px, uint32_t p_budget, uint64_t p_edge_count) {
	if (p_budget < COUNT_DEFAULT_BUDGET) {
		return p_budget;
	}
	const uint32_t side = choose_groups_per_block_side(p_size_px, p_budget);
	const glm::uvec2 blocks = divide_up(divide_up(p_size_px, EDGE_COUNT_GROUP_PX), side);
	const uint64_t room = MOST_LIST_BYTES / sizeof(uint32_t) / (uint64_t(blocks.x) * blocks.y);
	// Powers of two: few sizes of memory while the scene changes.
	const uint64_t wanted = std::min(std::bit_floor(room), std::bit_ceil(p_edge_count));
	return static_cast<uint32_t>(
			std::clamp<uint64_t>(wanted, p_budget, std::max(p_budget, COUNT_MOST_BUDGET)));
}

CountBlocks add_block_passes(RenderGraph &r_graph, const CountBlockPasses &p_passes) {
	const ShadowTechnique::Inputs &inputs = p_passes.inputs;
	const shader::CountLightConstants constants = make_light_constants(p_passes);
	const uint64_t group_count = uint64_t(constants.group_count.x) * constants.group_count.y;
	const uint64_t block_count = uint64_t(constants.block_count.x) * constants.block_count.y;
	CountBlocks blocks;
	blocks.receivers = make_map_resolve_bindings(r_graph, inputs);
	blocks.constants = r_graph.upload_constants("counted light", constants);
	const RGBuffer boxes = r_graph.create_buffer({ "receiver boxes",
			group_count * constants.view_count * EDGE_COUNT_BOXES_PER_GROUP *
					sizeof(shader::CountGroupBox),
			BufferUsage::STORAGE });
	const auto make_texel_buffer = [&](const char *p_name, uint64_t p_count) {
		return r_graph.create_buffer({ p_name, p_count * sizeof(uint32_t),
				BufferUsage::STORAGE | BufferUsage::TEXEL, MemoryKind::GPU, Format::R32_UINT });
	};
	blocks.ends = make_texel_buffer("block ends", block_count * EDGE_COUNT_ENDS_PER_BLOCK);
	blocks.lists =
			make_texel_buffer("block edges", block_count * std::max(constants.list_capacity, 1u));
	blocks.block_count = static_cast<uint32_t>(block_count);
	blocks.blocks = make_texel_buffer("blocks by kind", EDGE_COUNT_BLOCK_KINDS * block_count);
	blocks.dispatches = r_graph.create_buffer(
			{ "block dispatches", EDGE_COUNT_DISPATCH_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::INDIRECT | BufferUsage::COPY_TARGET });
	r_graph.add_pass("clear blocks")
			.writes(blocks.dispatches, Access::COPY_WRITE)
			.execute([dispatches = blocks.dispatches](PassContext &p_context) {
				p_context.commands.fill_buffer(p_context.get(dispatches), 0);
			});
	// One subgroup is one work group.
	const uint32_t subgroup_size = inputs.device.get_features().subgroup_size;
	const auto get_pipeline = [&](const char *p_shader) {
		return inputs.device.get_compute_pipeline({ p_shader, p_shader,
				{ { EDGE_COUNT_CONSTANT_GROUP_SIZE, subgroup_size },
						{ EDGE_COUNT_CONSTANT_VIEW_COUNT, constants.view_count } } });
	};
	std::vector<PassBinding> bindings = blocks.receivers;
	bindings.push_back(PassBinding::constants(COUNT_BINDING_LIGHT, blocks.constants));
	bindings.push_back(PassBinding::write(COUNT_BINDING_BOXES, boxes));
	add_compute_pass(r_graph, "receiver boxes",
			get_pipeline("shadow_edge_count/receiver_boxes.comp"), std::move(bindings),
			{ constants.group_count.x * subgroup_size, constants.group_count.y, 1 });
	add_compute_pass(r_graph, "list blocks", get_pipeline("shadow_edge_count/list_blocks.comp"),
			{ PassBinding::constants(COUNT_BINDING_LIGHT, blocks.constants),
					PassBinding::read(COUNT_BINDING_BOXES, boxes),
					PassBinding::read(COUNT_BINDING_RECORDS, p_passes.light.records),
					PassBinding::read(COUNT_BINDING_BUNDLES, p_passes.light.bundles),
					PassBinding::read(COUNT_BINDING_TOTALS, p_passes.light.totals),
					PassBinding::write(COUNT_BINDING_ENDS, blocks.ends),
					PassBinding::write(COUNT_BINDING_LISTS, blocks.lists),
					PassBinding::write(COUNT_BINDING_BLOCKS, blocks.blocks),
					PassBinding::write(COUNT_BINDING_DISPATCHES, blocks.dispatches,
							PassBuilder::Content::UPDATE) },
			{ constants.block_count.x * subgroup_size, constants.block_count.y, 1 });
	return blocks;
}

RGTexture add_count_passes(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	const RGTexture mask = create_mask(r_graph, p_passes.inputs.size_px);
	std::vector<PassBinding> bindings = make_plain_bindings(p_passes, p_blocks);
	bindings.push_back(PassBinding::write(COUNT_BINDING_OUTPUT, mask));
	add_kind_pass(r_graph, p_passes, p_blocks, "resolve plain",
			"shadow_edge_count/resolve_plain.comp", EDGE_COUNT_BLOCKS_PLAIN, std::move(bindings));
	bindings = make_count_bindings(p_passes, p_blocks);
	bindings.push_back(
			PassBinding::write(COUNT_BINDING_OUTPUT, mask, PassBuilder::Content::UPDATE));
	add_kind_pass(r_graph, p_passes, p_blocks, "resolve",
			p_passes.settings.sample_count > EDGE_COUNT_SAMPLE_COUNT
					? "shadow_edge_count/resolve_fine.comp"
					: "shadow_edge_count/resolve.comp",
			EDGE_COUNT_BLOCKS_COUNTED, std::move(bindings));
	if (p_passes.may_be_over) {
		add_filter_passes(r_graph, p_passes, p_blocks, mask);
	}
	return mask;
}

RGTexture add_count_debug_pass(
		RenderGraph &r_graph, const CountBlockPasses &p_passes, const CountBlocks &p_blocks) {
	const RGTexture output =
			r_graph.create_texture({ "counted", Format::R16_SFLOAT, p_passes.inputs.size_px,
					EDGE_COUNT_DEBUG_LAYERS, TextureUsage::STORAGE | TextureUsage::SAMPLED });
	for (uint32_t kind = 0; kind < EDGE_COUNT_BLOCK_KINDS; ++kind) {
		std::vector<PassBinding> bindings = make_count_bindings(p_passes, p_blocks);
		bindings.push_back(PassBinding::write(COUNT_BINDING_OUTPUT, output,
				kind == 0 ? PassBuilder::Content::FRESH : PassBuilder::Content::UPDATE));
		add_kind_pass(r_graph, p_passes, p_blocks, text("debug ", kind),
				"shadow_edge_count/debug.comp", kind, std::move(bindings));
	}
	return output;
}

} // namespace gnomon
