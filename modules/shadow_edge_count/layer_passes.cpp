#include "modules/core/text.h"
#include "modules/render_graph/compute_pass.h"
#include "modules/shadow_edge_count/view_passes.h"

#include <algorithm>

namespace gnomon {

namespace {

using Content = PassBuilder::Content;

/// A pass that draws all casters without targets: its fragment shader stores.
template <typename Bind>
void add_draw_pass(RenderingDevice &p_device, PassBuilder p_pass, const char *p_shader,
		const CountViewPasses &p_passes, Bind p_bind,
		const std::vector<SpecializationConstant> &p_constants = {}) {
	RasterPipelineDesc desc;
	desc.name = p_shader;
	desc.constants = p_constants;
	desc.vertex_shader = "shadow_edge_count/layers.vert";
	desc.fragment_shader = p_shader;
	desc.attributes = { { 0, 0, Format::R32_SFLOAT, 3, 0 } };
	desc.vertex_strides_bytes = { sizeof(glm::vec4) };
	desc.has_depth = false;
	desc.writes_depth = false;
	const PipelineRID pipeline = p_device.get_raster_pipeline(desc);
	p_pass.execute(
			[=, casters = p_passes.casters.casters, size_px = p_passes.map_size_px,
					capacity = p_passes.capacities.fragments_per_view](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.begin_rendering_without_targets(size_px);
				commands.bind_pipeline(pipeline);
				commands.bind_resources(p_bind(p_context));
				for (const CountCaster &caster : casters) {
					const BufferRID positions[] = { caster.gpu->positions.get() };
					commands.push_constants(shader::CountLayersPush{ caster.clip_from_node,
							caster.push.first_face, caster.push.kind, capacity, 0 });
					commands.bind_vertex_buffers(positions);
					commands.bind_index_buffer(caster.gpu->faces.get());
					commands.draw_indexed(3 * caster.gpu->face_count);
				}
				commands.end_rendering();
			});
}

std::string make_name(const char *p_what, const CountViewPasses &p_passes) {
	return text(p_what, " view ", p_passes.index);
}

/// All faces of each texel: count, add up, fill.
void add_all_layers(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes) {
	const CountFrameBuffers light = p_passes.light;
	const RGBuffer planes = p_passes.view.planes;
	const RGBuffer constants = p_passes.constants;
	const uint32_t texel_count = p_passes.capacities.texels_per_view;
	const uint32_t group_count =
			(texel_count + LAYERS_TEXELS_PER_GROUP - 1) / LAYERS_TEXELS_PER_GROUP;
	const RGBuffer counts = r_graph.create_buffer({ "layer counts", texel_count * sizeof(uint32_t),
			BufferUsage::STORAGE | BufferUsage::COPY_TARGET });
	const RGBuffer sums = r_graph.create_buffer(
			{ "layer sums", group_count * sizeof(uint32_t), BufferUsage::STORAGE });
	r_graph.add_pass(make_name("clear layers", p_passes))
			.writes(counts, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.fill_buffer(p_context.get(counts), 0);
			});
	add_draw_pass(p_device,
			r_graph.add_pass(make_name("count layers", p_passes))
					.reads(constants, Access::UNIFORM_READ)
					.writes(counts, Access::SHADER_WRITE_FRAGMENT, Content::UPDATE),
			"shadow_edge_count/count_layers.frag", p_passes, [=](PassContext &p_context) {
				return std::vector<Binding>{ { LAYERS_BINDING_VIEW, p_context.get(constants) },
					{ LAYERS_BINDING_COUNTS, p_context.get(counts) } };
			});
	add_compute_pass(r_graph, make_name("add up layers", p_passes),
			p_device.get_compute_pipeline(
					{ "add up layers", "shadow_edge_count/sum_layers.comp", {} }),
			{ PassBinding::read(LAYERS_BINDING_COUNTS, counts),
					PassBinding::write(LAYERS_BINDING_SUMS, sums) },
			{ group_count * LAYERS_GROUP_SIZE, 1, 1 });
	add_part_pass(r_graph, p_device, make_name("place layers", p_passes),
			"shadow_edge_count/place_layers.comp", p_passes,
			{ PassBinding::constants(LAYERS_BINDING_VIEW, constants),
					PassBinding::read(LAYERS_BINDING_COUNTS, counts),
					PassBinding::read(LAYERS_BINDING_SUMS, sums),
					PassBinding::write(LAYERS_BINDING_TEXELS, light.texels, Content::UPDATE),
					PassBinding::write(LAYERS_BINDING_FRAGMENTS, light.fragments, Content::UPDATE),
					PassBinding::write(LAYERS_BINDING_TOTALS, light.totals, Content::UPDATE) },
			group_count * LAYERS_GROUP_SIZE);
	add_draw_pass(p_device,
			r_graph.add_pass(make_name("fill layers", p_passes))
					.reads(constants, Access::UNIFORM_READ)
					.reads(planes, Access::SHADER_READ_FRAGMENT)
					.reads(light.texels, Access::SHADER_READ_FRAGMENT)
					.writes(counts, Access::SHADER_WRITE_FRAGMENT, Content::UPDATE)
					.writes(light.fragments, Access::SHADER_WRITE_FRAGMENT, Content::UPDATE),
			"shadow_edge_count/fill_layers.frag", p_passes, [=](PassContext &p_context) {
				return std::vector<Binding>{ { LAYERS_BINDING_VIEW, p_context.get(constants) },
					{ LAYERS_BINDING_PLANES, p_context.get(planes) },
					{ LAYERS_BINDING_COUNTS, p_context.get(counts) },
					{ LAYERS_BINDING_TEXELS, p_context.get(light.texels) },
					{ LAYERS_BINDING_FRAGMENTS, p_context.get(light.fragments) } };
			});
}

/// Of each texel the nearest faces that are turned away from the light.
void add_nearest_layers(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes) {
	const CountFrameBuffers light = p_passes.light;
	const RGBuffer planes = p_passes.view.planes;
	const RGBuffer constants = p_passes.constants;
	const std::vector<SpecializationConstant> specialization = { { LAYERS_CONSTANT_COUNT,
			p_passes.layer_count } };
	add_part_pass(r_graph, p_device, make_name("clear layers", p_passes),
			"shadow_edge_count/place_nearest.comp", p_passes,
			{ PassBinding::constants(LAYERS_BINDING_VIEW, constants),
					PassBinding::write(LAYERS_BINDING_TEXELS, light.texels, Content::UPDATE),
					PassBinding::write(
							LAYERS_BINDING_FRAGMENTS, light.fragments, Content::UPDATE) },
			p_passes.capacities.texels_per_view, specialization);
	add_draw_pass(
			p_device,
			r_graph.add_pass(make_name("nearest layers", p_passes))
					.reads(constants, Access::UNIFORM_READ)
					.reads(planes, Access::SHADER_READ_FRAGMENT)
					.writes(light.fragments, Access::SHADER_WRITE_FRAGMENT, Content::UPDATE),
			"shadow_edge_count/nearest_layers.frag", p_passes,
			[=](PassContext &p_context) {
				return std::vector<Binding>{ { LAYERS_BINDING_VIEW, p_context.get(constants) },
					{ LAYERS_BINDING_PLANES, p_context.get(planes) },
					{ LAYERS_BINDING_FRAGMENTS, p_context.get(light.fragments) } };
			},
			specialization);
}

} // namespace

void add_layer_passes(
		RenderGraph &r_graph, RenderingDevice &p_device, const CountViewPasses &p_passes) {
	if (p_passes.layer_count == 0) {
		add_all_layers(r_graph, p_device, p_passes);
	} else {
		add_nearest_layers(r_graph, p_device, p_passes);
	}
	const CountFrameBuffers light = p_passes.light;
	add_part_pass(r_graph, p_device, make_name("bury texels", p_passes),
			"shadow_edge_count/bury_texels.comp", p_passes,
			{ PassBinding::constants(LAYERS_BINDING_VIEW, p_passes.constants),
					PassBinding::write(LAYERS_BINDING_TEXELS, light.texels, Content::UPDATE),
					PassBinding::read(LAYERS_BINDING_TOTALS, light.totals),
					PassBinding::read(LAYERS_BINDING_RECORDS, light.records) },
			std::min(p_passes.casters.edge_count, p_passes.capacities.records_per_view));
}

} // namespace gnomon
