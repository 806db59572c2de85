#include "modules/render_graph/fill_pass.h"

#include "modules/core/files.h"
#include "modules/render_graph/compute_pass.h"

#include "render_graph/render_graph_shared.h"

namespace gnomon {

void add_fill_pass(RenderGraph &r_graph, RenderingDevice &p_device, const std::string &p_name,
		RGBuffer p_buffer, uint32_t p_value) {
	const PipelineRID pipeline =
			p_device.get_compute_pipeline({ "fill", "render_graph/fill.comp", {} });
	const uint32_t word_count =
			static_cast<uint32_t>(r_graph.get_desc(p_buffer).size_bytes / sizeof(uint32_t));
	const shader::FillPush push = { p_value, word_count, /*padding0=*/0, /*padding1=*/0 };
	add_compute_pass(r_graph, p_name, pipeline,
			{ PassBinding::write(FILL_BINDING_WORDS, p_buffer) }, glm::uvec3(word_count, 1, 1),
			bytes_of(std::span(&push, 1)));
}

void add_clear_pass(RenderGraph &r_graph, const std::string &p_name, RGTexture p_texture,
		float p_value, uint32_t p_layer) {
	r_graph.add_pass(p_name)
			.writes(p_texture, Access::COPY_WRITE,
					p_layer == Binding::ALL_LAYERS ? PassBuilder::Content::FRESH
												   : PassBuilder::Content::UPDATE)
			.execute([=](PassContext &p_context) {
				p_context.commands.clear_color(
						p_context.get(p_texture), glm::vec4(p_value), p_layer);
			});
}

} // namespace gnomon
