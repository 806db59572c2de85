#include "modules/renderer/drawn_mask.h"

namespace gnomon {

RGTexture create_drawn_mask(RenderGraph &r_graph, glm::uvec2 p_size_px) {
	return r_graph.create_texture({ "shadow mask", Format::R16_SFLOAT, p_size_px, 1,
			TextureUsage::SAMPLED | TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE });
}

RGTexture create_stencil_target(
		RenderGraph &r_graph, const std::string &p_name, glm::uvec2 p_size_px) {
	return r_graph.create_texture(
			{ p_name, Format::D32_SFLOAT_S8_UINT, p_size_px, 1, TextureUsage::DEPTH_ATTACHMENT });
}

RasterPipelineDesc make_screen_desc(
		const std::string &p_name, const std::string &p_fragment_shader) {
	RasterPipelineDesc desc;
	desc.name = p_name;
	desc.vertex_shader = "renderer/screen.vert";
	desc.fragment_shader = p_fragment_shader;
	desc.color_formats = { Format::R16_SFLOAT };
	desc.has_stencil = true;
	desc.depth_compare = CompareOp::ALWAYS;
	desc.writes_depth = false;
	return desc;
}

} // namespace gnomon
