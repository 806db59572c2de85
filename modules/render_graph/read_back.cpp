#include "modules/render_graph/read_back.h"

namespace gnomon {

RGBuffer add_copy_for_host(RenderGraph &r_graph, RGTexture p_texture, uint32_t p_layer) {
	const TextureDesc desc = r_graph.get_desc(p_texture);
	const RGBuffer buffer = r_graph.create_buffer({ desc.name + " readback",
			compute_layer_bytes(desc), BufferUsage::COPY_TARGET, MemoryKind::READBACK });
	r_graph.add_pass("read back " + desc.name)
			.reads(p_texture, Access::COPY_READ)
			.writes(buffer, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.copy_texture_to_buffer(
						p_context.get(p_texture), p_context.get(buffer), p_layer);
			});
	return buffer;
}

void add_readback(RenderGraph &r_graph, RGTexture p_texture, std::vector<uint8_t> &r_bytes,
		uint32_t p_layer) {
	const RGBuffer buffer = add_copy_for_host(r_graph, p_texture, p_layer);
	const uint64_t size_bytes = r_graph.get_desc(buffer).size_bytes;
	r_graph.add_pass("copy " + r_graph.get_desc(p_texture).name)
			.reads(buffer, Access::HOST_READ)
			.keep()
			.execute_on_host([=, &r_bytes](HostContext &p_context) {
				const uint8_t *mapped = p_context.get_mapped(buffer);
				r_bytes.assign(mapped, mapped + size_bytes);
			});
}

} // namespace gnomon
