#include "modules/shadow_penumbra_fins/edge_passes.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

/// A caster's buffers live as long as the mesh, which the frame's scene holds.
struct EdgeDispatch {
	BufferRID positions;
	BufferRID edges;
	uint32_t word_count = 0;
	shader::EdgesPush push;
};

std::vector<EdgeDispatch> build_dispatches(
		const FinCasters &p_casters, uint32_t p_vertices_per_edge) {
	std::vector<EdgeDispatch> dispatches;
	for (const FinCaster &caster : p_casters.casters) {
		EdgeDispatch dispatch;
		dispatch.positions = caster.gpu->positions.get();
		dispatch.edges = caster.gpu->edges.get();
		dispatch.word_count = caster.word_count;
		dispatch.push = { caster.light_node, caster.gpu->edge_count, caster.first_word,
			caster.first_block, caster.first_in_list, static_cast<uint32_t>(dispatches.size()),
			p_vertices_per_edge, 0, 0 };
		dispatches.push_back(dispatch);
	}
	return dispatches;
}

} // namespace

EdgeLists add_edge_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const FinCasters &p_casters, uint32_t p_vertices_per_edge) {
	GNOMON_ASSERT(!p_casters.casters.empty(), "edge passes without a caster");
	const auto make_buffer = [&](const char *p_name, uint64_t p_count, uint64_t p_item_bytes,
									 BufferUsage p_usage) {
		return r_graph.create_buffer(
				{ p_name, p_count * p_item_bytes, BufferUsage::STORAGE | p_usage });
	};
	const RGBuffer words =
			make_buffer("edge words", p_casters.word_count, sizeof(uint32_t), BufferUsage::STORAGE);
	const RGBuffer blocks = make_buffer(
			"edge blocks", p_casters.block_count, sizeof(uint32_t), BufferUsage::COPY_TARGET);
	EdgeLists lists;
	lists.list = make_buffer(
			"silhouette edges", p_casters.edge_count, sizeof(uint32_t), BufferUsage::COPY_SOURCE);
	lists.draws = make_buffer("fin draws", p_casters.casters.size(), sizeof(shader::FinsDraw),
			BufferUsage::INDIRECT | BufferUsage::COPY_SOURCE);
	const std::vector<EdgeDispatch> dispatches = build_dispatches(p_casters, p_vertices_per_edge);
	r_graph.add_pass("clear edges")
			.writes(blocks, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.fill_buffer(p_context.get(blocks), 0);
			});
	const PipelineRID find_pipeline = p_device.get_compute_pipeline(
			{ "find edges", "shadow_penumbra_fins/find_edges.comp", {} });
	r_graph.add_pass("find edges")
			.writes(words, Access::SHADER_WRITE_COMPUTE)
			.writes(blocks, Access::SHADER_WRITE_COMPUTE, PassBuilder::Content::UPDATE)
			.execute([=](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(find_pipeline);
				for (const EdgeDispatch &dispatch : dispatches) {
					commands.bind_resources({ { EDGES_BINDING_POSITIONS, dispatch.positions },
							{ EDGES_BINDING_EDGES, dispatch.edges },
							{ EDGES_BINDING_WORDS, p_context.get(words) },
							{ EDGES_BINDING_BLOCKS, p_context.get(blocks) } });
					commands.push_constants(dispatch.push);
					commands.dispatch_items({ dispatch.word_count, 1, 1 });
				}
			});
	const PipelineRID list_pipeline = p_device.get_compute_pipeline(
			{ "list edges", "shadow_penumbra_fins/list_edges.comp", {} });
	r_graph.add_pass("list edges")
			.reads(words, Access::SHADER_READ_COMPUTE)
			.reads(blocks, Access::SHADER_READ_COMPUTE)
			.writes(lists.list, Access::SHADER_WRITE_COMPUTE)
			.writes(lists.draws, Access::SHADER_WRITE_COMPUTE)
			.execute([=](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.bind_pipeline(list_pipeline);
				commands.bind_resources({ { EDGES_BINDING_WORDS, p_context.get(words) },
						{ EDGES_BINDING_BLOCKS, p_context.get(blocks) },
						{ EDGES_BINDING_LIST, p_context.get(lists.list) },
						{ EDGES_BINDING_DRAWS, p_context.get(lists.draws) } });
				for (const EdgeDispatch &dispatch : dispatches) {
					commands.push_constants(dispatch.push);
					commands.dispatch_items({ dispatch.word_count, 1, 1 });
				}
			});
	return lists;
}

} // namespace gnomon
