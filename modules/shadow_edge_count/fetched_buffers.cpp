#include "modules/shadow_edge_count/fetched_buffers.h"

namespace gnomon {

BufferDesc make_fetched_buffer_desc(const RenderingDevice &p_device, const std::string &p_name,
		uint64_t p_size_bytes, Format p_format) {
	BufferDesc desc = { .name = p_name, .size_bytes = p_size_bytes };
	if (p_device.get_features().storage_and_texel_buffers) {
		desc.usage = BufferUsage::STORAGE | BufferUsage::TEXEL;
		desc.texel_format = p_format;
	}
	return desc;
}

std::string choose_fetching_shader(const RenderingDevice &p_device, const std::string &p_shader) {
	return p_device.get_features().storage_and_texel_buffers ? p_shader
															 : get_storage_variant(p_shader);
}

std::string get_storage_variant(const std::string &p_shader) {
	std::string variant = p_shader;
	return variant.insert(variant.rfind('.'), ".storage");
}

} // namespace gnomon
