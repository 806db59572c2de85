#include "modules/core/text.h"
#include "modules/shadow_edge_count/view_passes.h"

#include <algorithm>

namespace gnomon {

namespace {

/// A pass that runs a shader once per caster. p_items: invocations that a caster needs; 0: it is
/// skipped.
template <typename Items, typename Bind>
void add_caster_pass(RenderingDevice &p_device, PassBuilder p_pass, const char *p_shader,
		const CountViewPasses &p_passes, Items p_items, Bind p_bind) {
	const PipelineRID pipeline = p_device.get_compute_pipeline({ p_shader, p_shader, {} });
	std::vector<CountCaster> casters;
	for (CountCaster caster : p_passes.casters.casters) {
		caster.push.record_capacity = p_passes.capacities.records_per_view;
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

} // namespace

void add_find_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes) {
	const CountFrameBuffers light = p_passes.light;
	const CountViewBuffers view = p_passes.view;
	const RGBuffer constants = p_passes.constants;
	const auto name = [&](const char *p_what) { return text(p_what, " view ", p_passes.index); };
	add_caster_pass(
			p_device,
			r_graph.add_pass(name("face planes"))
					.writes(view.planes, Access::SHADER_WRITE_COMPUTE,
							PassBuilder::Content::UPDATE),
			"shadow_edge_count/face_planes.comp", p_passes,
			[](const CountCaster &p_caster) {
				return p_caster.is_moved ? p_caster.gpu->face_count : 0u;
			},
			[=](PassContext &p_context, const CountCaster &p_caster) {
				return std::vector<Binding>{ { FIND_BINDING_POSITIONS,
													 p_caster.gpu->positions.get() },
					{ FIND_BINDING_FACES, p_caster.gpu->faces.get() },
					{ FIND_BINDING_PLANES, p_context.get(view.planes) } };
			});
	const auto bind_edges = [=](PassContext &p_context, const CountCaster &p_caster) {
		return std::vector<Binding>{ { FIND_BINDING_VIEW, p_context.get(constants) },
			{ FIND_BINDING_POSITIONS, p_caster.gpu->positions.get() },
			{ FIND_BINDING_PLANES, p_context.get(view.planes) },
			{ FIND_BINDING_EDGES, p_caster.gpu->edges.get() },
			{ FIND_BINDING_WORDS, p_context.get(view.words) },
			{ FIND_BINDING_BLOCKS, p_context.get(view.blocks) } };
	};
	add_caster_pass(
			p_device,
			r_graph.add_pass(name("mark edges"))
					.reads(constants, Access::UNIFORM_READ)
					.reads(view.planes, Access::SHADER_READ_COMPUTE)
					.writes(view.words, Access::SHADER_WRITE_COMPUTE, PassBuilder::Content::UPDATE)
					.writes(view.blocks, Access::SHADER_WRITE_COMPUTE,
							PassBuilder::Content::UPDATE),
			"shadow_edge_count/mark_edges.comp", p_passes,
			[](const CountCaster &p_caster) {
				return p_caster.is_moved ? p_caster.gpu->word_count : 0u;
			},
			bind_edges);
	add_caster_pass(
			p_device,
			r_graph.add_pass(name("list edges"))
					.reads(constants, Access::UNIFORM_READ)
					.reads(view.planes, Access::SHADER_READ_COMPUTE)
					.reads(view.words, Access::SHADER_READ_COMPUTE)
					.reads(view.blocks, Access::SHADER_READ_COMPUTE)
					.writes(light.records, Access::SHADER_WRITE_COMPUTE,
							PassBuilder::Content::UPDATE)
					.writes(light.totals, Access::SHADER_WRITE_COMPUTE,
							PassBuilder::Content::UPDATE),
			"shadow_edge_count/list_edges.comp", p_passes,
			[](const CountCaster &p_caster) { return p_caster.gpu->word_count; },
			[=](PassContext &p_context, const CountCaster &p_caster) {
				std::vector<Binding> bindings = bind_edges(p_context, p_caster);
				bindings.emplace_back(FIND_BINDING_LIST, p_context.get(light.records));
				bindings.emplace_back(FIND_BINDING_TOTALS, p_context.get(light.totals));
				return bindings;
			});
	const uint32_t most_records =
			std::min(p_passes.casters.edge_count, p_passes.capacities.records_per_view);
	add_part_pass(r_graph, p_device, name("bound edges"), "shadow_edge_count/bound_edges.comp",
			p_passes,
			{ PassBinding::constants(FIND_BINDING_VIEW, constants),
					PassBinding::read(FIND_BINDING_LIST, light.records),
					PassBinding::read(FIND_BINDING_TOTALS, light.totals),
					PassBinding::write(
							FIND_BINDING_BUNDLES, light.bundles, PassBuilder::Content::UPDATE) },
			(most_records + EDGE_COUNT_BUNDLE_SIZE - 1) / EDGE_COUNT_BUNDLE_SIZE);
}

} // namespace gnomon
