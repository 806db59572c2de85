#include "modules/shadows/caster_pass.h"

#include <algorithm>
#include <numeric>

namespace gnomon {

std::vector<CasterDraw> build_caster_draws(const ShadowTechnique::Inputs &p_inputs,
		const LightView &p_view, const CasterList &p_casters) {
	std::vector<CasterDraw> draws;
	for (uint32_t index : p_casters.instances) {
		const InstanceSnapshot &instance = p_inputs.scene.instances[index];
		draws.push_back({ &p_inputs.meshes.get(instance.caster_mesh),
				{ p_view.compute_clip_from_node(instance.world_from_node) } });
	}
	return draws;
}

RasterPipelineDesc make_caster_pipeline_desc(const RenderingDevice &p_device) {
	RasterPipelineDesc desc;
	desc.vertex_shader = "shadows/depth.vert";
	desc.attributes = get_position_attributes();
	desc.vertex_strides_bytes = { sizeof(glm::vec3) };
	desc.depth_compare = CompareOp::GREATER;
	desc.clamps_depth = p_device.get_features().depth_clamp;
	return desc;
}

void record_caster_draws(CommandList &r_commands, const std::vector<CasterDraw> &p_draws) {
	for (const CasterDraw &draw : p_draws) {
		const BufferRID positions[] = { draw.mesh->positions.get() };
		r_commands.push_constants(draw.push);
		r_commands.bind_vertex_buffers(positions);
		r_commands.bind_index_buffer(draw.mesh->indices.get());
		r_commands.draw_indexed(draw.mesh->index_count);
	}
}

void add_depth_pass(RenderGraph &r_graph, const std::string &p_name,
		const ShadowTechnique::Inputs &p_inputs, const LightView &p_view,
		const CasterList &p_casters, RGTexture p_target, uint32_t p_layer) {
	RasterPipelineDesc desc = make_caster_pipeline_desc(p_inputs.device);
	desc.name = "light view depth";
	const PipelineRID pipeline = p_inputs.device.get_raster_pipeline(desc);
	r_graph.add_pass(p_name)
			.depth(p_target, LoadOp::CLEAR, 0.0f, p_layer)
			.execute([draws = build_caster_draws(p_inputs, p_view, p_casters), pipeline](
							 PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				record_caster_draws(p_context.commands, draws);
			});
}

std::vector<uint32_t> collect_casters(
		const ShadowTechnique::Inputs &p_inputs, const std::vector<uint32_t> &p_view_indices) {
	if (p_view_indices.size() == 1) {
		return p_inputs.casters[p_view_indices.front()].instances;
	}
	std::vector<uint32_t> instances;
	for (uint32_t view : p_view_indices) {
		const std::vector<uint32_t> &listed = p_inputs.casters[view].instances;
		instances.insert(instances.end(), listed.begin(), listed.end());
	}
	std::sort(instances.begin(), instances.end());
	instances.erase(std::unique(instances.begin(), instances.end()), instances.end());
	return instances;
}

std::vector<LightView> build_listing_views(
		const LightSnapshot &p_light, const LightScene &p_scene) {
	const uint32_t size_px = 64; // any size will do: nothing is drawn into these views
	const uint32_t border_px = 1;
	return build_light_views(p_light, p_scene, size_px, border_px);
}

std::vector<uint32_t> list_casters(const ShadowTechnique::Inputs &p_inputs, TechniquePlan &r_plan) {
	std::vector<uint32_t> views(p_inputs.views.size());
	std::iota(views.begin(), views.end(), 0u);
	for (uint32_t view : views) {
		r_plan.skip_light_view(view, "the technique needs no shadow map");
	}
	return collect_casters(p_inputs, views);
}

} // namespace gnomon
