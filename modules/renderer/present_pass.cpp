#include "modules/renderer/present_pass.h"

#include "modules/shadows/mask.h"

#include "renderer/renderer_shared.h"

namespace gnomon {

void add_present_pass(RenderGraph &r_graph, RGTexture p_image,
		std::function<std::optional<TextureRID>()> p_acquire) {
	const RGTexture shown = r_graph.import_window_image(std::move(p_acquire));
	const glm::uvec2 image_size_px = r_graph.get_desc(p_image).size_px;
	r_graph.add_pass("present")
			.reads(p_image, Access::SHADER_READ_FRAGMENT)
			.color(shown, LoadOp::DISCARD)
			.execute([=](PassContext &p_context) {
				RenderingDevice &device = p_context.get_device();
				const TextureDesc window = device.get_desc(p_context.get(shown));
				RasterPipelineDesc desc = make_screen_desc("present", "renderer/present.frag");
				desc.color_formats = { window.format }; // known only once it is acquired
				desc.has_depth = desc.has_stencil = false;
				shader::PresentPush push = {};
				push.image_px_per_window_px = glm::vec2(image_size_px) / glm::vec2(window.size_px);
				p_context.commands.bind_pipeline(device.get_raster_pipeline(desc));
				p_context.commands.bind_resources(
						{ { PRESENT_BINDING_IMAGE, p_context.get(p_image) } });
				p_context.commands.push_constants(push);
				p_context.commands.draw(3);
			});
}

} // namespace gnomon
