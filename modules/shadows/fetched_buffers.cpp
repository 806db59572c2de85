#include "modules/shadows/fetched_buffers.h"

namespace gnomon {

BufferUsage get_fetched_usage(const RenderingDevice &p_device) {
	return p_device.get_features().storage_and_texel_buffers
			? BufferUsage::STORAGE | BufferUsage::TEXEL
			: BufferUsage::STORAGE;
}

BufferDesc make_fetched_buffer_desc(const RenderingDevice &p_device, const std::string &p_name,
		uint64_t p_size_bytes, Format p_format) {
	return { .name = p_name,
		.size_bytes = p_size_bytes,
		.usage = get_fetched_usage(p_device),
		.texel_format = p_format };
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
