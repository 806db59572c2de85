#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

namespace {

VkImageSubresourceLayers make_layers(
		const TextureDesc &p_desc, uint32_t p_layer, uint32_t p_layer_count) {
	GNOMON_ASSERT(p_layer + p_layer_count <= p_desc.layer_count, "texture '", p_desc.name, "' has ",
			p_desc.layer_count, " layers, ", p_layer, " was requested");
	GNOMON_ASSERT(!has_stencil(p_desc.format), "texture '", p_desc.name, "' is ",
			get_format_name(p_desc.format), ", which cannot be copied");
	return { get_aspect(p_desc.format), /*mipLevel=*/0, p_layer, p_layer_count };
}

VkBufferImageCopy make_layer_copy(const BufferDesc &p_buffer, const TextureDesc &p_texture,
		uint32_t p_layer, uint64_t p_offset_bytes = 0) {
	GNOMON_ASSERT(p_buffer.size_bytes >= p_offset_bytes + compute_layer_bytes(p_texture),
			"buffer '", p_buffer.name, "' has ", p_buffer.size_bytes, " bytes, a layer of '",
			p_texture.name, "' needs ", compute_layer_bytes(p_texture), " at offset ",
			p_offset_bytes);
	return { .bufferOffset = p_offset_bytes,
		.imageSubresource = make_layers(p_texture, p_layer, 1),
		.imageExtent = { p_texture.size_px.x, p_texture.size_px.y, 1 } };
}

} // namespace

void VulkanCommandList::check_copy(const char *p_call) const {
	check_recording(p_call);
	GNOMON_ASSERT(!is_rendering, p_call, " inside begin_rendering .. end_rendering");
}

void VulkanCommandList::clear_buffer(BufferRID p_buffer) {
	check_copy("clear_buffer");
	vkCmdFillBuffer(commands, device->buffers.get(p_buffer).buffer, 0, VK_WHOLE_SIZE, 0);
}

void VulkanCommandList::copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
		uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) {
	copy_buffer(device->buffers.get(p_source), device->buffers.get(p_target), p_size_bytes,
			p_source_offset_bytes, p_target_offset_bytes);
}

void VulkanCommandList::copy_buffer(const BufferResource &p_source, const BufferResource &p_target,
		uint64_t p_size_bytes, uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) {
	check_copy("copy_buffer");
	GNOMON_ASSERT(p_source_offset_bytes + p_size_bytes <= p_source.desc.size_bytes &&
					p_target_offset_bytes + p_size_bytes <= p_target.desc.size_bytes,
			"copy of ", p_size_bytes, " bytes from '", p_source.desc.name, "' at ",
			p_source_offset_bytes, " of ", p_source.desc.size_bytes, " to '", p_target.desc.name,
			"' at ", p_target_offset_bytes, " of ", p_target.desc.size_bytes);
	const VkBufferCopy region = { p_source_offset_bytes, p_target_offset_bytes, p_size_bytes };
	vkCmdCopyBuffer(commands, p_source.buffer, p_target.buffer, 1, &region);
}

void VulkanCommandList::copy_texture_to_buffer(
		TextureRID p_source, BufferRID p_target, uint32_t p_layer) {
	copy_texture_to_buffer(device->textures.get(p_source), device->buffers.get(p_target), p_layer);
}

void VulkanCommandList::copy_texture_to_buffer(
		const TextureResource &p_source, const BufferResource &p_target, uint32_t p_layer) {
	check_copy("copy_texture_to_buffer");
	const VkBufferImageCopy region = make_layer_copy(p_target.desc, p_source.desc, p_layer);
	vkCmdCopyImageToBuffer(commands, p_source.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
			p_target.buffer, 1, &region);
}

void VulkanCommandList::copy_buffer_to_texture(
		BufferRID p_source, TextureRID p_target, uint32_t p_layer, uint64_t p_source_offset_bytes) {
	check_copy("copy_buffer_to_texture");
	const BufferResource &source = device->buffers.get(p_source);
	const TextureResource &target = device->textures.get(p_target);
	const VkBufferImageCopy region =
			make_layer_copy(source.desc, target.desc, p_layer, p_source_offset_bytes);
	vkCmdCopyBufferToImage(commands, source.buffer, target.image,
			VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

void VulkanCommandList::copy_texture(TextureRID p_source, TextureRID p_target) {
	check_copy("copy_texture");
	const TextureResource &source = device->textures.get(p_source);
	const TextureResource &target = device->textures.get(p_target);
	const uint32_t layer_count = source.desc.layer_count;
	GNOMON_ASSERT(source.desc.format == target.desc.format &&
					source.desc.size_px == target.desc.size_px &&
					layer_count == target.desc.layer_count,
			"copy_texture of '", source.desc.name, "' to '", target.desc.name,
			"', which differ in format, size or layer count");
	const VkImageCopy region = { .srcSubresource = make_layers(source.desc, 0, layer_count),
		.dstSubresource = make_layers(target.desc, 0, layer_count),
		.extent = { source.desc.size_px.x, source.desc.size_px.y, 1 } };
	vkCmdCopyImage(commands, source.image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.image,
			VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

} // namespace gnomon
