#include "modules/core/error.h"
#include "modules/render_graph/render_graph_types.h"

namespace gnomon {

TextureRID PassContext::get(RGTexture p_texture) const {
	GNOMON_ASSERT(p_texture, "an empty texture handle");
	return graph.resources[p_texture.index].texture;
}

BufferRID PassContext::get(RGBuffer p_buffer) const {
	GNOMON_ASSERT(p_buffer, "an empty buffer handle");
	return graph.resources[p_buffer.index].buffer;
}

RenderingDevice &PassContext::get_device() const {
	return graph.device;
}

uint8_t *HostContext::get_mapped(RGBuffer p_buffer) const {
	GNOMON_ASSERT(p_buffer, "an empty buffer handle");
	return graph.device.get_mapped(graph.resources[p_buffer.index].buffer);
}

PassBuilder &PassBuilder::reads(RGResource p_resource, Access p_access) {
	graph.add_use(pass_index,
			{ p_resource.index, p_access, /*is_written=*/false, /*needs_content=*/true });
	return *this;
}

PassBuilder &PassBuilder::writes(RGResource p_resource, Access p_access, Content p_content) {
	graph.add_use(pass_index,
			{ p_resource.index, p_access, /*is_written=*/true, p_content == Content::UPDATE });
	return *this;
}

PassBuilder &PassBuilder::color(
		RGTexture p_texture, LoadOp p_load, glm::vec4 p_clear, uint32_t p_layer) {
	// Other layers of an array keep their content, whatever this one's load operation does.
	const bool is_array = graph.get_desc(p_texture).layer_count > 1;
	graph.add_use(pass_index,
			{ p_texture.index, Access::COLOR_WRITE, /*is_written=*/true,
					is_array || p_load == LoadOp::KEEP });
	graph.passes[pass_index].colors.push_back(
			{ p_texture, { /*texture=*/{}, p_load, p_clear, p_layer } });
	return *this;
}

PassBuilder &PassBuilder::depth(
		RGTexture p_texture, LoadOp p_load, float p_clear, uint32_t p_layer) {
	const bool is_array = graph.get_desc(p_texture).layer_count > 1; // as in color()
	graph.add_use(pass_index,
			{ p_texture.index, Access::DEPTH_WRITE, /*is_written=*/true,
					is_array || p_load == LoadOp::KEEP });
	graph.passes[pass_index].depth = { p_texture, { /*texture=*/{}, p_load, p_clear, p_layer } };
	return *this;
}

PassBuilder &PassBuilder::without_targets(glm::uvec2 p_size_px) {
	graph.passes[pass_index].size_without_targets_px = p_size_px;
	return *this;
}

PassBuilder &PassBuilder::keep() {
	graph.passes[pass_index].is_retained = true;
	return *this;
}

PassBuilder &PassBuilder::needs_time() {
	graph.passes[pass_index].needs_time = true;
	return *this;
}

void PassBuilder::execute(std::function<void(PassContext &)> p_record) {
	graph.passes[pass_index].record = std::move(p_record);
}

void PassBuilder::execute_on_host(std::function<void(HostContext &)> p_run) {
	graph.passes[pass_index].run_on_host = std::move(p_run);
}

} // namespace gnomon
