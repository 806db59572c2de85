#include "modules/rendering_device_vulkan/vulkan_formats.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

// In the order of Format.
const VkFormat FORMATS[] = {
	VK_FORMAT_R8_UNORM,
	VK_FORMAT_R16_SFLOAT,
	VK_FORMAT_R32_SFLOAT,
	VK_FORMAT_R32_UINT,
	VK_FORMAT_R16G16_SFLOAT,
	VK_FORMAT_R32G32_UINT,
	VK_FORMAT_R32G32_SFLOAT,
	VK_FORMAT_R8G8B8A8_UNORM,
	VK_FORMAT_R8G8B8A8_SRGB,
	VK_FORMAT_B8G8R8A8_UNORM,
	VK_FORMAT_R16G16B16A16_SFLOAT,
	VK_FORMAT_R32G32B32A32_SFLOAT,
	VK_FORMAT_R32G32B32A32_UINT,
	VK_FORMAT_D32_SFLOAT,
	VK_FORMAT_D32_SFLOAT_S8_UINT,
};
static_assert(std::size(FORMATS) == static_cast<size_t>(Format::D32_SFLOAT_S8_UINT) + 1);

const std::pair<TextureUsage, VkFlags> TEXTURE_USAGES[] = {
	{ TextureUsage::SAMPLED, VK_IMAGE_USAGE_SAMPLED_BIT },
	{ TextureUsage::STORAGE, VK_IMAGE_USAGE_STORAGE_BIT },
	{ TextureUsage::COLOR_ATTACHMENT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT },
	{ TextureUsage::DEPTH_ATTACHMENT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT },
	{ TextureUsage::COPY_SOURCE, VK_IMAGE_USAGE_TRANSFER_SRC_BIT },
	{ TextureUsage::COPY_TARGET, VK_IMAGE_USAGE_TRANSFER_DST_BIT },
};

const std::pair<BufferUsage, VkFlags> BUFFER_USAGES[] = {
	{ BufferUsage::VERTEX, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT },
	{ BufferUsage::INDEX, VK_BUFFER_USAGE_INDEX_BUFFER_BIT },
	{ BufferUsage::UNIFORM, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT },
	{ BufferUsage::STORAGE, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT },
	{ BufferUsage::INDIRECT, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT },
	{ BufferUsage::CONDITIONAL, VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT },
	{ BufferUsage::COPY_SOURCE, VK_BUFFER_USAGE_TRANSFER_SRC_BIT },
	{ BufferUsage::COPY_TARGET, VK_BUFFER_USAGE_TRANSFER_DST_BIT },
	{ BufferUsage::TEXEL, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT },
};

template <typename Usage>
VkFlags join_flags(Usage p_usage, std::span<const std::pair<Usage, VkFlags>> p_rows) {
	VkFlags flags = 0;
	for (const auto &[usage, flag] : p_rows) {
		flags |= has_usage(p_usage, usage) ? flag : 0;
	}
	return flags;
}

} // namespace

VkFormat get_vulkan_format(Format p_format) {
	const size_t index = static_cast<size_t>(p_format);
	GNOMON_ASSERT(index < std::size(FORMATS), "format ", index);
	return FORMATS[index];
}

VkImageAspectFlags get_aspect(Format p_format) {
	if (has_stencil(p_format)) {
		return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
	}
	return is_depth_format(p_format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageUsageFlags get_vulkan_usage(TextureUsage p_usage) {
	return join_flags<TextureUsage>(p_usage, TEXTURE_USAGES);
}

VkBufferUsageFlags get_vulkan_usage(BufferUsage p_usage) {
	return join_flags<BufferUsage>(p_usage, BUFFER_USAGES);
}

VkFormat get_attribute_format(const VertexAttribute &p_attribute) {
	static const VkFormat FLOATS[] = { VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT,
		VK_FORMAT_R32G32B32_SFLOAT, VK_FORMAT_R32G32B32A32_SFLOAT };
	static const VkFormat UINTS[] = { VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT,
		VK_FORMAT_R32G32B32_UINT, VK_FORMAT_R32G32B32A32_UINT };
	const uint32_t count = p_attribute.component_count;
	GNOMON_ASSERT(count >= 1 && count <= 4, "attribute ", p_attribute.location, " has ", count,
			" components");
	if (p_attribute.format == Format::R32_SFLOAT) {
		return FLOATS[count - 1];
	}
	if (p_attribute.format == Format::R32_UINT) {
		return UINTS[count - 1];
	}
	return get_vulkan_format(p_attribute.format);
}

} // namespace gnomon
