#include "modules/rendering_device/formats.h"

#include "modules/core/error.h"

namespace gnomon {

namespace {

struct FormatRow {
	const char *name;
	VkFormat format;
	uint32_t texel_size_bytes;
};

// In the order of Format.
const FormatRow FORMATS[] = {
	{ "R8_UNORM", VK_FORMAT_R8_UNORM, 1 },
	{ "R16_SFLOAT", VK_FORMAT_R16_SFLOAT, 2 },
	{ "R32_SFLOAT", VK_FORMAT_R32_SFLOAT, 4 },
	{ "R32_UINT", VK_FORMAT_R32_UINT, 4 },
	{ "RG16_SFLOAT", VK_FORMAT_R16G16_SFLOAT, 4 },
	{ "RG32_UINT", VK_FORMAT_R32G32_UINT, 8 },
	{ "RG32_SFLOAT", VK_FORMAT_R32G32_SFLOAT, 8 },
	{ "RGBA8_UNORM", VK_FORMAT_R8G8B8A8_UNORM, 4 },
	{ "RGBA8_SRGB", VK_FORMAT_R8G8B8A8_SRGB, 4 },
	{ "RGBA16_SFLOAT", VK_FORMAT_R16G16B16A16_SFLOAT, 8 },
	{ "RGBA32_SFLOAT", VK_FORMAT_R32G32B32A32_SFLOAT, 16 },
	{ "RGBA32_UINT", VK_FORMAT_R32G32B32A32_UINT, 16 },
	{ "D32_SFLOAT", VK_FORMAT_D32_SFLOAT, 4 },
	{ "D32_SFLOAT_S8_UINT", VK_FORMAT_D32_SFLOAT_S8_UINT, 8 },
};
static_assert(std::size(FORMATS) == static_cast<size_t>(Format::D32_SFLOAT_S8_UINT) + 1);

struct TextureUsageRow {
	TextureUsage usage;
	VkImageUsageFlags flag;
	const char *name;
};

const TextureUsageRow TEXTURE_USAGES[] = {
	{ TextureUsage::SAMPLED, VK_IMAGE_USAGE_SAMPLED_BIT, "SAMPLED" },
	{ TextureUsage::STORAGE, VK_IMAGE_USAGE_STORAGE_BIT, "STORAGE" },
	{ TextureUsage::COLOR_ATTACHMENT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, "COLOR_ATTACHMENT" },
	{ TextureUsage::DEPTH_ATTACHMENT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
			"DEPTH_ATTACHMENT" },
	{ TextureUsage::COPY_SOURCE, VK_IMAGE_USAGE_TRANSFER_SRC_BIT, "COPY_SOURCE" },
	{ TextureUsage::COPY_TARGET, VK_IMAGE_USAGE_TRANSFER_DST_BIT, "COPY_TARGET" },
};

struct BufferUsageRow {
	BufferUsage usage;
	VkBufferUsageFlags flag;
};

const BufferUsageRow BUFFER_USAGES[] = {
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

const FormatRow &get_row(Format p_format) {
	const size_t index = static_cast<size_t>(p_format);
	GNOMON_ASSERT(index < std::size(FORMATS), "format ", index);
	return FORMATS[index];
}

} // namespace

uint32_t get_texel_size_bytes(Format p_format) {
	return get_row(p_format).texel_size_bytes;
}

const char *get_format_name(Format p_format) {
	return get_row(p_format).name;
}

VkFormat get_vulkan_format(Format p_format) {
	return get_row(p_format).format;
}

bool is_depth_format(Format p_format) {
	return p_format == Format::D32_SFLOAT || has_stencil(p_format);
}

bool has_stencil(Format p_format) {
	return p_format == Format::D32_SFLOAT_S8_UINT;
}

bool is_uint_format(Format p_format) {
	return p_format == Format::R32_UINT || p_format == Format::RG32_UINT;
}

VkImageAspectFlags get_aspect(Format p_format) {
	if (has_stencil(p_format)) {
		return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
	}
	return is_depth_format(p_format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

VkImageUsageFlags get_vulkan_usage(TextureUsage p_usage) {
	VkImageUsageFlags flags = 0;
	for (const TextureUsageRow &row : TEXTURE_USAGES) {
		flags |= has_usage(p_usage, row.usage) ? row.flag : 0;
	}
	return flags;
}

VkBufferUsageFlags get_vulkan_usage(BufferUsage p_usage) {
	VkBufferUsageFlags flags = 0;
	for (const BufferUsageRow &row : BUFFER_USAGES) {
		flags |= has_usage(p_usage, row.usage) ? row.flag : 0;
	}
	return flags;
}

std::string describe_usage(TextureUsage p_usage) {
	std::string names;
	for (const TextureUsageRow &row : TEXTURE_USAGES) {
		if (has_usage(p_usage, row.usage)) {
			names += (names.empty() ? "" : " | ") + std::string(row.name);
		}
	}
	return names;
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
