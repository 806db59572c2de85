#include "modules/shadow_penumbra_fins/layer_passes.h"

#include "modules/core/error.h"
#include "modules/mesh_tools/topology.h"
#include "modules/renderer/caster_pass.h"

#include <algorithm>

namespace gnomon {

namespace {

/// A word that a peel sets when it finds anything: the predicate of the peel after it.
RGBuffer add_found_flag(RenderGraph &r_graph) {
	const RGBuffer flag = r_graph.create_buffer({ "layer found", sizeof(uint32_t),
			BufferUsage::STORAGE | BufferUsage::CONDITIONAL | BufferUsage::COPY_TARGET });
	r_graph.add_pass("clear layer found")
			.writes(flag, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.fill_buffer(p_context.get(flag), 0);
			});
	return flag;
}

/// Behind the front of a closed caster is its back. Only where there is none, a second layer may be
/// empty, and only then the peels ask: asking costs a third of a peel.
bool may_layer_2_be_empty(const ShadowTechnique::Inputs &p_inputs, const CasterList &p_casters) {
	return std::none_of(
			p_casters.instances.begin(), p_casters.instances.end(), [&](uint32_t p_index) {
				const auto topology = get_topology(p_inputs.scene.instances[p_index].mesh);
				return topology->mesh_class == MeshClass::CLOSED;
			});
}

PipelineRID get_peel_pipeline(RenderingDevice &p_device, bool p_tells_found) {
	RasterPipelineDesc desc = make_caster_pipeline_desc(p_device);
	desc.name = "peel";
	desc.fragment_shader = "shadow_penumbra_fins/peel.frag";
	desc.constants = { { PEEL_CONSTANT_TELLS_FOUND, p_tells_found ? 1u : 0u } };
	return p_device.get_raster_pipeline(desc);
}

void add_peels(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs, uint32_t p_view_index,
		std::span<const RGTexture> p_layers) {
	const LightView &view = p_inputs.views[p_view_index];
	const CasterList &casters = p_inputs.casters[p_view_index];
	add_depth_pass(r_graph, text("layer 1 view ", p_view_index), p_inputs, view, casters,
			p_layers[0], p_view_index);
	if (p_layers.size() == 1) {
		return;
	}
	const DeviceFeatures &features = p_inputs.device.get_features();
	const bool is_conditional = p_inputs.may_leave_out && features.conditional_rendering &&
			features.fragment_stores && p_layers.size() > 2 &&
			may_layer_2_be_empty(p_inputs, casters);
	const RGBuffer found = add_found_flag(r_graph);
	for (uint32_t layer = 1; layer < p_layers.size(); ++layer) {
		const RGTexture nearer = p_layers[layer - 1];
		const bool tells_found = is_conditional && layer == 1;
		const bool asks_found = is_conditional && layer == 2;
		const PipelineRID pipeline = get_peel_pipeline(p_inputs.device, tells_found);
		PassBuilder pass = r_graph.add_pass(text("layer ", layer + 1, " view ", p_view_index));
		pass.reads(nearer, Access::SHADER_READ_FRAGMENT)
				.depth(p_layers[layer], LoadOp::CLEAR, 0.0f, p_view_index);
		if (asks_found) {
			pass.reads(found, Access::CONDITIONAL_READ);
		} else {
			pass.writes(found, Access::SHADER_WRITE_FRAGMENT, PassBuilder::Content::UPDATE);
		}
		pass.execute([=, draws = build_caster_draws(p_inputs, view, casters)](
							 PassContext &p_context) {
			CommandList &commands = p_context.commands;
			Binding nearer_layer(PEEL_BINDING_NEARER, p_context.get(nearer));
			nearer_layer.layer = p_view_index;
			commands.bind_pipeline(pipeline);
			commands.bind_resources({ nearer_layer, { PEEL_BINDING_FOUND, p_context.get(found) } });
			if (asks_found) {
				commands.begin_conditional(p_context.get(found));
			}
			record_caster_draws(commands, draws);
			if (asks_found) {
				commands.end_conditional();
			}
		});
	}
}

void add_one_pass(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, std::span<const RGTexture> p_layers) {
	const LightView &view = p_inputs.views[p_view_index];
	const uint32_t texel_count = view.size_px.x * view.size_px.y;
	const uint64_t layer_bytes = uint64_t(texel_count) * sizeof(uint32_t);
	RasterPipelineDesc desc = make_caster_pipeline_desc(p_inputs.device);
	desc.name = "layers in one pass";
	desc.fragment_shader = "shadow_penumbra_fins/layers.frag";
	desc.has_depth = false;
	desc.writes_depth = false;
	desc.constants = { { LAYERS_CONSTANT_WIDTH_PX, view.size_px.x },
		{ LAYERS_CONSTANT_TEXEL_COUNT, texel_count },
		{ FINS_CONSTANT_LAYER_COUNT, static_cast<uint32_t>(p_layers.size()) } };
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);
	const RGBuffer texels = r_graph.create_buffer({ "depth layers", layer_bytes * p_layers.size(),
			BufferUsage::STORAGE | BufferUsage::COPY_SOURCE | BufferUsage::COPY_TARGET });
	r_graph.add_pass(text("clear layers view ", p_view_index))
			.writes(texels, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.fill_buffer(p_context.get(texels), 0);
			});
	r_graph.add_pass(text("layers view ", p_view_index))
			.writes(texels, Access::SHADER_WRITE_FRAGMENT, PassBuilder::Content::UPDATE)
			.execute([=, size_px = view.size_px,
							 draws = build_caster_draws(p_inputs, view,
									 p_inputs.casters[p_view_index])](PassContext &p_context) {
				CommandList &commands = p_context.commands;
				commands.begin_rendering_without_targets(size_px);
				commands.bind_pipeline(pipeline);
				commands.bind_resources({ { LAYERS_BINDING_TEXELS, p_context.get(texels) } });
				record_caster_draws(commands, draws);
				commands.end_rendering();
			});
	PassBuilder copy = r_graph.add_pass(text("copy layers view ", p_view_index));
	copy.reads(texels, Access::COPY_READ);
	const bool is_array = r_graph.get_desc(p_layers[0]).layer_count > 1;
	for (const RGTexture &layer : p_layers) {
		copy.writes(layer, Access::COPY_WRITE,
				is_array ? PassBuilder::Content::UPDATE : PassBuilder::Content::FRESH);
	}
	copy.execute([=, layers = std::vector<RGTexture>(p_layers.begin(), p_layers.end())](
						 PassContext &p_context) {
		for (size_t layer = 0; layer < layers.size(); ++layer) {
			p_context.commands.copy_buffer_to_texture(p_context.get(texels),
					p_context.get(layers[layer]), p_view_index, layer * layer_bytes);
		}
	});
}

} // namespace

void add_layer_passes(RenderGraph &r_graph, const ShadowTechnique::Inputs &p_inputs,
		uint32_t p_view_index, std::span<const RGTexture> p_layers, Peeling p_peeling) {
	GNOMON_ASSERT(!p_layers.empty() && p_layers.size() <= FINS_MAX_LAYERS, p_layers.size(),
			" depth layers");
	if (p_peeling == Peeling::ONE_PASS && p_layers.size() > 1) {
		add_one_pass(r_graph, p_inputs, p_view_index, p_layers);
	} else {
		add_peels(r_graph, p_inputs, p_view_index, p_layers);
	}
}

} // namespace gnomon
