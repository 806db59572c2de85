#include "modules/godot_addon/scaled_masks.h"

#include "modules/render_graph/compute_pass.h"
#include "modules/rendering_device_godot/godot_device.h"

#include "godot_addon/godot_addon_shared.h"

#include <algorithm>

namespace gnomon {

glm::uvec2 ScaledMasks::compute_size(glm::uvec2 p_size_px, float p_scale) {
	return glm::max(glm::uvec2(glm::ceil(glm::vec2(p_size_px) * p_scale)), 1u);
}

ScaledMasks::ScaledMasks(RenderGraph &r_graph, RenderingDevice &p_device, RGTexture p_depth,
		float p_scale, uint32_t p_count) :
		graph(r_graph),
		device(p_device), full_depth(p_depth), full_size_px(r_graph.get_desc(p_depth).size_px),
		count(p_count), size_px(compute_size(full_size_px, p_scale)), depth(p_depth) {
	if (size_px == full_size_px) {
		return;
	}
	depth = graph.create_texture({ "depth of masks", Format::D32_SFLOAT, size_px, 1,
			TextureUsage::DEPTH_ATTACHMENT | TextureUsage::SAMPLED });
	RasterPipelineDesc desc;
	desc.name = "scale depth";
	desc.vertex_shader = "shadows/screen.vert";
	desc.fragment_shader = "godot_addon/scale_depth.frag";
	desc.depth_compare = CompareOp::ALWAYS;
	const PipelineRID pipeline = device.get_raster_pipeline(desc);
	shader::ScalePush push = {};
	push.ratio = glm::vec2(full_size_px) / glm::vec2(size_px);
	graph.add_pass("scale depth")
			.reads(full_depth, Access::SHADER_READ_FRAGMENT)
			.depth(depth, LoadOp::CLEAR, 0.0f)
			.execute([=, source = full_depth](PassContext &p_context) {
				p_context.commands.bind_pipeline(pipeline);
				p_context.commands.bind_resources(
						{ { SCALE_BINDING_FULL_DEPTH, p_context.get(source) } });
				p_context.commands.push_constants(push);
				p_context.commands.draw(3);
			});
}

RGTexture ScaledMasks::create_target(RGTexture p_result) {
	if (size_px == full_size_px) {
		return p_result;
	}
	target = graph.create_texture(
			{ "scaled masks", Format::R16_SFLOAT, size_px, std::max(count, MIN_ARRAY_LAYER_COUNT),
					TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_TARGET,
					/*is_array=*/true });
	return target;
}

void ScaledMasks::write(RGTexture p_result) {
	if (size_px == full_size_px) {
		return;
	}
	shader::ScalePush push = {};
	push.ratio = glm::vec2(size_px) / glm::vec2(full_size_px);
	add_compute_pass(graph, "scale masks",
			device.get_compute_pipeline({ "scale masks", "godot_addon/scale_masks.comp", {} }),
			{ PassBinding::read(SCALE_BINDING_FULL_DEPTH, full_depth),
					PassBinding::read(SCALE_BINDING_DEPTH, depth),
					PassBinding::read(SCALE_BINDING_MASKS, target),
					PassBinding::write(
							SCALE_BINDING_RESULT, p_result, PassBuilder::Content::UPDATE) },
			glm::uvec3(full_size_px, count),
			std::span(reinterpret_cast<const uint8_t *>(&push), sizeof(push)));
}

} // namespace gnomon
