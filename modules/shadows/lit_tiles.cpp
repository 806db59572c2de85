#include "modules/shadows/lit_tiles.h"

#include "shared/lit_tiles_shared.h"

namespace gnomon {

namespace {

uint32_t count_tiles(glm::uvec2 p_size_px) {
	const glm::uvec2 tiles = (p_size_px + (LIT_TILE_PX - 1u)) / uint32_t(LIT_TILE_PX);
	return tiles.x * tiles.y;
}

} // namespace

RGBuffer add_tile_depths_pass(RenderGraph &r_graph, RenderingDevice &p_device, RGBuffer p_frame,
		RGTexture p_depth, glm::uvec2 p_size_px) {
	const uint32_t tile_count = count_tiles(p_size_px);
	const RGBuffer depths = r_graph.create_buffer(
			{ "tile depths", tile_count * sizeof(glm::vec2), BufferUsage::STORAGE });
	add_compute_pass(r_graph, "tile depths",
			p_device.get_compute_pipeline({ "tile depths", "shadows/tile_depths.comp", {} }),
			{
					PassBinding::constants(LIT_TILES_BINDING_FRAME, p_frame),
					PassBinding::read(LIT_TILES_BINDING_DEPTH, p_depth),
					PassBinding::write(LIT_TILES_BINDING_TILE_DEPTHS, depths),
			},
			{ tile_count, 1, 1 });
	return depths;
}

LitTiles add_lit_tiles_pass(RenderGraph &r_graph, RenderingDevice &p_device, RGBuffer p_frame,
		RGBuffer p_light_constants, RGBuffer p_tile_depths, glm::uvec2 p_size_px,
		bool p_lists_all) {
	const uint32_t tile_count = count_tiles(p_size_px);
	LitTiles result;
	result.tiles = r_graph.create_buffer(
			{ "lit tiles", (LIT_TILES_FIRST + uint64_t(tile_count)) * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::COPY_TARGET | BufferUsage::COPY_SOURCE });
	result.arguments = r_graph.create_buffer(
			{ "dispatches of lit tiles", LIT_TILES_ARGUMENT_WORDS * sizeof(uint32_t),
					BufferUsage::STORAGE | BufferUsage::INDIRECT | BufferUsage::COPY_TARGET });
	r_graph.add_pass("clear lit tiles")
			.writes(result.tiles, Access::COPY_WRITE)
			.writes(result.arguments, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.clear_buffer(p_context.get(result.tiles));
				p_context.commands.clear_buffer(p_context.get(result.arguments));
			});
	const shader::LitTilesPush push = { p_lists_all ? 1u : 0u, 0, 0, 0 };
	add_compute_pass(r_graph, "lit tiles",
			p_device.get_compute_pipeline({ "lit tiles", "shadows/lit_tiles.comp", {} }),
			{
					PassBinding::constants(LIT_TILES_BINDING_FRAME, p_frame),
					PassBinding::constants(LIT_TILES_BINDING_LIGHT, p_light_constants),
					PassBinding::read(LIT_TILES_BINDING_TILE_DEPTHS, p_tile_depths),
					PassBinding::write(
							LIT_TILES_BINDING_TILES, result.tiles, PassBuilder::Content::UPDATE),
					PassBinding::write(LIT_TILES_BINDING_ARGUMENTS, result.arguments,
							PassBuilder::Content::UPDATE),
			},
			{ tile_count, 1, 1 }, make_push_bytes(push));
	return result;
}

void add_tile_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, const LitTiles &p_tiles, uint32_t p_tiles_binding,
		std::vector<uint8_t> p_push, TileDispatch p_dispatch) {
	p_bindings.push_back(PassBinding::read(p_tiles_binding, p_tiles.tiles));
	ComputeStep step = { p_pipeline, std::move(p_bindings), std::move(p_push) };
	step.arguments = p_tiles.arguments;
	step.arguments_offset_bytes = sizeof(uint32_t) *
			(p_dispatch == TileDispatch::TILES ? LIT_TILES_TILE_ARGUMENTS
											   : LIT_TILES_BLOCK_ARGUMENTS);
	add_compute_steps(r_graph, p_name, { std::move(step) });
}

} // namespace gnomon
