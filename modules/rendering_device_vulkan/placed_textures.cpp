#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

namespace {

VkMemoryRequirements get_image_requirements(VkDevice p_device, const VkImageCreateInfo &p_info) {
	const VkDeviceImageMemoryRequirements requirements_info = {
		.sType = VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS, .pCreateInfo = &p_info
	};
	VkMemoryRequirements2 requirements = { .sType = VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2 };
	vkGetDeviceImageMemoryRequirements(p_device, &requirements_info, &requirements);
	return requirements.memoryRequirements;
}

} // namespace

RenderingDevice::PlacementRequirements VulkanDevice::get_placement_requirements(
		const TextureDesc &p_desc) {
	fail_if_lost();
	GNOMON_ASSERT(features.aliased_memory, "texture '", p_desc.name,
			"' cannot be placed: the device has no aliased_memory");
	check_texture_limits(p_desc);
	const VkMemoryRequirements needs = get_image_requirements(device, make_image_info(p_desc));
	return { needs.size, needs.alignment };
}

MemoryRID VulkanDevice::create_texture_memory(const std::string &p_name, uint64_t p_size_bytes) {
	fail_if_lost();
	GNOMON_ASSERT(features.aliased_memory, "memory '", p_name,
			"' cannot be shared by textures: the device has no aliased_memory");
	GNOMON_ASSERT(p_size_bytes > 0, "memory '", p_name, "' has no bytes");
	// Allow only the memory types that colour, storage and depth images have in common. They do not
	// depend on the size.
	const TextureDesc examples[] = {
		{ "", Format::RGBA16_SFLOAT, glm::uvec2(256), 1,
				TextureUsage::SAMPLED | TextureUsage::COLOR_ATTACHMENT },
		{ "", Format::R32_SFLOAT, glm::uvec2(256), 2, TextureUsage::SAMPLED | TextureUsage::STORAGE,
				/*is_array=*/true },
		{ "", Format::D32_SFLOAT, glm::uvec2(256), 1,
				TextureUsage::SAMPLED | TextureUsage::DEPTH_ATTACHMENT },
	};
	MemoryRequest request = {
		.needs = { .size = p_size_bytes, .alignment = 1, .memoryTypeBits = ~0u },
		.kind = MemoryKind::GPU,
		.tiling = Tiling::OPTIMAL
	};
	for (const TextureDesc &example : examples) {
		const VkMemoryRequirements needs = get_image_requirements(device, make_image_info(example));
		request.needs.memoryTypeBits &= needs.memoryTypeBits;
		request.needs.alignment = std::max(request.needs.alignment, needs.alignment);
	}
	MemoryResource memory;
	memory.desc = { p_name, p_size_bytes };
	memory.memory = allocate("memory '" + p_name + "'", request);
	return memories.add(std::move(memory));
}

TextureRID VulkanDevice::create_placed_texture(
		const TextureDesc &p_desc, MemoryRID p_memory, uint64_t p_offset_bytes) {
	fail_if_lost();
	MemoryResource &memory = memories.get(p_memory);
	TextureResource texture = make_image(p_desc);
	VkMemoryRequirements needs;
	vkGetImageMemoryRequirements(device, texture.image, &needs);
	const MemoryBlock &block = *memory.memory.block;
	const uint64_t offset = memory.memory.offset_bytes + p_offset_bytes;
	GNOMON_ASSERT(
			offset % needs.alignment == 0 && p_offset_bytes + needs.size <= memory.desc.size_bytes,
			"texture '", p_desc.name, "' of ", needs.size, " bytes, alignment ", needs.alignment,
			", does not fit into memory '", memory.desc.name, "' of ", memory.desc.size_bytes,
			" bytes at ", p_offset_bytes);
	GNOMON_ASSERT((needs.memoryTypeBits & (1u << block.memory_type)) != 0, "texture '", p_desc.name,
			"' cannot be in memory type ", block.memory_type);
	texture.placed_in = p_memory;
	try {
		check(vkBindImageMemory(device, texture.image, block.memory, offset), "vkBindImageMemory");
	} catch (...) {
		destroy(texture);
		throw;
	}
	++memory.texture_count;
	return textures.add(std::move(texture));
}

void VulkanDevice::free(MemoryRID p_memory) {
	MemoryResource memory = memories.remove(p_memory);
	GNOMON_ASSERT(memory.texture_count == 0, "memory '", memory.desc.name, "' still holds ",
			memory.texture_count, " textures");
	defer_free(std::move(memory));
}

} // namespace gnomon
