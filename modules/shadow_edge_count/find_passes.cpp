#include "modules/shadow_edge_count/find_passes.h"

#include "modules/core/text.h"
#include "modules/shadows/fetched_buffers.h"

namespace gnomon {

namespace {

using Content = PassBuilder::Content;

/// Adds a pass that runs a shader once per caster. p_items: number of invocations that a caster
/// needs; 0: it is skipped. p_bind: returns the bindings of a caster.
template <typename Items, typename Bind>
void add_caster_pass(RenderingDevice &p_device, PassBuilder p_pass, const char *p_shader,
		const CountFindPasses &p_passes, Items p_items, Bind p_bind) {
	const PipelineRID pipeline = p_device.get_compute_pipeline(
			{ p_shader, choose_fetching_shader(p_device, p_shader), /*constants=*/{} });
	std::vector<CountCaster> casters;
	for (const CountCaster &caster : p_passes.casters.casters) {
		if (p_items(caster) > 0) {
			casters.push_back(caster);
		}
	}
	p_pass.execute([=, casters = std::move(casters)](PassContext &p_context) {
		p_context.commands.bind_pipeline(pipeline);
		for (const CountCaster &caster : casters) {
			p_context.commands.bind_resources(p_bind(p_context, caster));
			p_context.commands.push_constants(caster.push);
			p_context.commands.dispatch_items({ p_items(caster), 1, 1 });
		}
	});
}

void add_edge_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes) {
	const CountFrameBuffers buffers = p_passes.buffers;
	add_caster_pass(
			p_device,
			r_graph.add_pass("mark edges")
					.reads(buffers.planes, Access::SHADER_READ_COMPUTE)
					.writes(buffers.words, Access::SHADER_WRITE_COMPUTE, Content::UPDATE)
					.writes(buffers.blocks, Access::SHADER_WRITE_COMPUTE, Content::UPDATE),
			"shadow_edge_count/mark_edges.comp", p_passes,
			[](const CountCaster &p_caster) {
				return p_caster.is_moved ? p_caster.gpu->word_count : 0u;
			},
			[=](PassContext &p_context, const CountCaster &p_caster) {
				return std::vector<Binding>{ { FIND_BINDING_POSITIONS, p_caster.positions },
					{ FIND_BINDING_MESH_EDGES, p_caster.gpu->edges.get() },
					{ FIND_BINDING_PLANES, p_context.get(buffers.planes) },
					{ FIND_BINDING_WORDS, p_context.get(buffers.words) },
					{ FIND_BINDING_BLOCKS, p_context.get(buffers.blocks) } };
			});
	add_caster_pass(
			p_device,
			r_graph.add_pass("list edges")
					.reads(buffers.words, Access::SHADER_READ_COMPUTE)
					.reads(buffers.blocks, Access::SHADER_READ_COMPUTE)
					.writes(buffers.edges, Access::SHADER_WRITE_COMPUTE, Content::UPDATE)
					.writes(buffers.totals, Access::SHADER_WRITE_COMPUTE, Content::UPDATE),
			"shadow_edge_count/list_edges.comp", p_passes,
			[](const CountCaster &p_caster) { return p_caster.gpu->word_count; },
			[=](PassContext &p_context, const CountCaster &p_caster) {
				return std::vector<Binding>{ { FIND_BINDING_POSITIONS, p_caster.positions },
					{ FIND_BINDING_MESH_EDGES, p_caster.gpu->edges.get() },
					{ FIND_BINDING_WORDS, p_context.get(buffers.words) },
					{ FIND_BINDING_BLOCKS, p_context.get(buffers.blocks) },
					{ FIND_BINDING_EDGES, p_context.get(buffers.edges) },
					{ FIND_BINDING_TOTALS, p_context.get(buffers.totals) } };
			});
	add_compute_pass(r_graph, "bound edges",
			p_device.get_compute_pipeline({ "bound edges",
					choose_fetching_shader(p_device, "shadow_edge_count/bound_edges.comp"),
					/*constants=*/{} }),
			{ PassBinding::read(FIND_BINDING_EDGES, buffers.edges),
					PassBinding::read(FIND_BINDING_FACES, buffers.faces),
					PassBinding::read(FIND_BINDING_TOTALS, buffers.totals),
					PassBinding::write(FIND_BINDING_BUNDLES, buffers.bundles, Content::UPDATE) },
			{ p_passes.capacities.get_bundle_count(), 1, 1 });
	add_compute_pass(r_graph, "bound bundles",
			p_device.get_compute_pipeline(
					{ "bound bundles", "shadow_edge_count/bound_bundles.comp", /*constants=*/{} }),
			{ PassBinding::constants(FIND_BINDING_LIGHT, p_passes.constants),
					PassBinding::read(FIND_BINDING_TOTALS, buffers.totals),
					PassBinding::write(FIND_BINDING_BUNDLES, buffers.bundles, Content::UPDATE) },
			{ p_passes.capacities.get_bundle_group_count(), 1, 1 });
}

struct FaceRange {
	uint32_t first = 0;
	uint32_t count = 0;
};

/// The faces of the casters that a view may see, as ranges of consecutive faces.
std::vector<FaceRange> find_seen_faces(const CountCasters &p_casters, uint32_t p_view_index) {
	std::vector<FaceRange> ranges;
	for (const CountCaster &caster : p_casters.casters) {
		if ((caster.views & 1u << p_view_index) == 0) {
			continue;
		}
		if (!ranges.empty() &&
				ranges.back().first + ranges.back().count == caster.push.first_face) {
			ranges.back().count += caster.push.face_count;
		} else {
			ranges.push_back({ caster.push.first_face, caster.push.face_count });
		}
	}
	return ranges;
}

/// Adds a compute pass with an indirect dispatch. p_word: offset of its arguments in p_dispatches,
/// in words.
void add_indirect_pass(RenderGraph &r_graph, const std::string &p_name, PipelineRID p_pipeline,
		std::vector<PassBinding> p_bindings, RGBuffer p_dispatches, uint32_t p_word,
		const shader::CountFaceListPush &p_push) {
	PassBuilder pass = r_graph.add_pass(p_name);
	declare_bindings(pass, p_bindings);
	pass.reads(p_dispatches, Access::INDIRECT_READ);
	pass.execute([=, bindings = std::move(p_bindings)](PassContext &p_context) {
		bind_compute(p_context, p_pipeline, bindings,
				std::span(reinterpret_cast<const uint8_t *>(&p_push), sizeof(p_push)));
		p_context.commands.dispatch_indirect(
				p_context.get(p_dispatches), p_word * sizeof(uint32_t));
	});
}

} // namespace

void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountFindPasses &p_passes) {
	const CountFrameBuffers buffers = p_passes.buffers;
	add_caster_pass(
			p_device,
			r_graph.add_pass("caster faces")
					.writes(buffers.planes, Access::SHADER_WRITE_COMPUTE, Content::UPDATE)
					.writes(buffers.faces, Access::SHADER_WRITE_COMPUTE, Content::UPDATE),
			"shadow_edge_count/caster_faces.comp", p_passes,
			[](const CountCaster &p_caster) {
				return p_caster.is_moved ? p_caster.gpu->face_count : 0u;
			},
			[=](PassContext &p_context, const CountCaster &p_caster) {
				return std::vector<Binding>{ { FIND_BINDING_POSITIONS, p_caster.positions },
					{ FIND_BINDING_MESH_FACES, p_caster.gpu->faces.get() },
					{ FIND_BINDING_SOURCE_PARTS, p_caster.gpu->source_parts.get() },
					{ FIND_BINDING_PLANES, p_context.get(buffers.planes) },
					{ FIND_BINDING_FACES, p_context.get(buffers.faces) } };
			});
	if (p_passes.has_edges) {
		add_edge_passes(r_graph, p_device, p_passes);
	}
	if (p_passes.capacities.cut_face_count > 0) {
		add_compute_pass(r_graph, "list cut faces",
				p_device.get_compute_pipeline({ "list cut faces",
						choose_fetching_shader(p_device, "shadow_edge_count/list_cut_faces.comp"),
						/*constants=*/{} }),
				{ PassBinding::constants(FACE_LIST_BINDING_LIGHT, p_passes.constants),
						PassBinding::read(FACE_LIST_BINDING_FACES, buffers.faces),
						PassBinding::write(
								FACE_LIST_BINDING_TOTALS, buffers.totals, Content::UPDATE),
						PassBinding::write(
								FACE_LIST_BINDING_CUT_FACES, buffers.cut_faces, Content::UPDATE) },
				{ 1, 1, 1 });
	}
}

void add_face_list_passes(RenderGraph &r_graph, RenderingDevice &p_device,
		const CountFindPasses &p_passes, uint32_t p_view_index) {
	// Each further attempt chooses larger texels from the node count of the previous one. The last
	// attempt uses a single texel.
	const uint32_t attempt_count = p_passes.may_overflow ? 5 : 1;
	const CountFrameBuffers buffers = p_passes.buffers;
	const std::string view = text(" view ", p_view_index);
	const auto get_pipeline = [&](const std::string &p_shader) {
		return p_device.get_compute_pipeline({ p_shader, p_shader,
				{ { EDGE_COUNT_CONSTANT_IS_DIRECTIONAL, p_passes.is_directional ? 1u : 0u } } });
	};
	const PipelineRID clear = get_pipeline("shadow_edge_count/clear_faces.comp");
	const PipelineRID list =
			get_pipeline(choose_fetching_shader(p_device, "shadow_edge_count/list_faces.comp"));
	const PassBinding constants =
			PassBinding::constants(FACE_LIST_BINDING_LIGHT, p_passes.constants);
	const PassBinding totals =
			PassBinding::write(FACE_LIST_BINDING_TOTALS, buffers.totals, Content::UPDATE);
	const PassBinding heads =
			PassBinding::write(FACE_LIST_BINDING_HEADS, buffers.heads, Content::UPDATE);
	const std::vector<PassBinding> list_bindings = { constants,
		PassBinding::read(FACE_LIST_BINDING_FACES, buffers.faces), heads,
		PassBinding::write(FACE_LIST_BINDING_NODES, buffers.nodes, Content::UPDATE), totals };
	RGBuffer dispatches;
	for (uint32_t attempt = 0; attempt < attempt_count; ++attempt) {
		const shader::CountFaceListPush push = { p_view_index, /*first_face=*/0,
			p_passes.capacities.face_count, /*is_first=*/attempt == 0 ? 1u : 0u,
			/*is_next_final=*/attempt + 2 == attempt_count ? 1u : 0u,
			p_passes.may_overflow ? 1u : 0u, /*padding0=*/0, /*padding1=*/0 };
		const auto push_bytes = std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push));
		const std::string suffix = attempt == 0 ? view : text(view, " attempt ", attempt);
		if (attempt == 0) {
			add_compute_pass(r_graph, "clear faces" + suffix, clear, { constants, heads, totals },
					{ p_passes.capacities.texels_per_view, 1, 1 }, push_bytes);
			PassBuilder pass = r_graph.add_pass("list faces" + suffix);
			declare_bindings(pass, list_bindings);
			pass.execute([list, list_bindings, push,
								 ranges = find_seen_faces(p_passes.casters, p_view_index)](
								 PassContext &p_context) {
				bind_compute(p_context, list, list_bindings, {});
				for (const FaceRange &range : ranges) {
					shader::CountFaceListPush range_push = push;
					range_push.first_face = range.first;
					range_push.face_count = range.count;
					p_context.commands.push_constants(range_push);
					p_context.commands.dispatch_items({ range.count, 1, 1 });
				}
			});
		} else {
			add_indirect_pass(r_graph, "clear faces" + suffix, clear, { constants, heads, totals },
					dispatches, FACE_LIST_DISPATCH_CLEAR, push);
			add_indirect_pass(r_graph, "list faces" + suffix, list, list_bindings, dispatches,
					FACE_LIST_DISPATCH_LIST, push);
		}
		if (attempt + 1 < attempt_count) {
			dispatches = r_graph.create_buffer(
					{ "face list dispatches", FACE_LIST_DISPATCH_WORDS * sizeof(uint32_t),
							BufferUsage::STORAGE | BufferUsage::INDIRECT });
			add_compute_pass(r_graph, "retry faces" + suffix,
					get_pipeline("shadow_edge_count/retry_faces.comp"),
					{ constants, totals,
							PassBinding::write(FACE_LIST_BINDING_DISPATCHES, dispatches) },
					{ 1, 1, 1 }, push_bytes);
		}
	}
}

} // namespace gnomon
