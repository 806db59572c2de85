#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

void VulkanDevice::check_texture_limits(const TextureDesc &p_desc) {
	GNOMON_ASSERT(p_desc.size_px.x > 0 && p_desc.size_px.y > 0 && p_desc.layer_count > 0,
			"texture '", p_desc.name, "' is ", p_desc.size_px.x, " x ", p_desc.size_px.y, " x ",
			p_desc.layer_count);
	GNOMON_ASSERT(p_desc.is_array || p_desc.layer_count == 1, "texture '", p_desc.name, "' has ",
			p_desc.layer_count, " layers, but is_array is false");
	const VkImageCreateInfo info = make_image_info(p_desc);
	const VkPhysicalDeviceImageFormatInfo2 format_info = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2,
		.format = info.format,
		.type = info.imageType,
		.tiling = info.tiling,
		.usage = info.usage
	};
	VkImageFormatProperties2 found = { .sType = VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2 };
	if (vkGetPhysicalDeviceImageFormatProperties2(physical.handle, &format_info, &found) !=
			VK_SUCCESS) {
		fail("Texture '", p_desc.name, "': device \"", physical.info.name, "\" has no format ",
				get_format_name(p_desc.format), " for the uses ", describe_usage(p_desc.usage),
				". Choose another device with --device.");
	}
	const VkExtent3D max_size = found.imageFormatProperties.maxExtent;
	const uint32_t max_layer_count = found.imageFormatProperties.maxArrayLayers;
	if (p_desc.size_px.x > max_size.width || p_desc.size_px.y > max_size.height ||
			p_desc.layer_count > max_layer_count) {
		fail("Texture '", p_desc.name, "' is ", p_desc.size_px.x, " x ", p_desc.size_px.y,
				" px with ", p_desc.layer_count, " layers; device \"", physical.info.name,
				"\" has at most ", max_size.width, " x ", max_size.height, " px and ",
				max_layer_count, " layers. Lower the map size, the layer count or the image size.");
	}
}

VkImageCreateInfo VulkanDevice::make_image_info(const TextureDesc &p_desc) {
	return { .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
		.imageType = VK_IMAGE_TYPE_2D,
		.format = get_vulkan_format(p_desc.format),
		.extent = { p_desc.size_px.x, p_desc.size_px.y, 1 },
		.mipLevels = p_desc.mip_count,
		.arrayLayers = p_desc.layer_count,
		.samples = VK_SAMPLE_COUNT_1_BIT,
		.tiling = VK_IMAGE_TILING_OPTIMAL,
		.usage = get_vulkan_usage(p_desc.usage),
		.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED };
}

TextureResource VulkanDevice::make_image(const TextureDesc &p_desc) {
	check_texture_limits(p_desc);
	TextureResource texture;
	texture.desc = p_desc;
	const VkImageCreateInfo info = make_image_info(p_desc);
	check(vkCreateImage(device, &info, nullptr, &texture.image), "vkCreateImage");
	set_name(VK_OBJECT_TYPE_IMAGE, texture.image, p_desc.name);
	return texture;
}

VkImageView VulkanDevice::get_view(
		TextureResource &r_texture, ViewUse p_use, uint32_t p_layer, bool p_is_arrayed) {
	const TextureDesc &desc = r_texture.desc;
	const bool has_all_layers = p_layer == Binding::ALL_LAYERS;
	GNOMON_ASSERT(has_all_layers || p_layer < desc.layer_count, "texture '", desc.name, "' has ",
			desc.layer_count, " layers, ", p_layer, " was requested");
	GNOMON_ASSERT(p_is_arrayed || !has_all_layers || desc.layer_count == 1, "texture '", desc.name,
			"' has ", desc.layer_count, " layers where the shader expects one");
	for (const TextureView &view : r_texture.views) {
		if (view.use == p_use && view.layer == p_layer && view.is_arrayed == p_is_arrayed) {
			return view.view;
		}
	}
	VkImageAspectFlags aspect = get_aspect(desc.format);
	if (p_use == ViewUse::SHADER) {
		aspect &= ~VkImageAspectFlags(VK_IMAGE_ASPECT_STENCIL_BIT);
	}
	const VkImageViewCreateInfo info = { .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
		.image = r_texture.image,
		.viewType = p_is_arrayed ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D,
		.format = get_vulkan_format(desc.format),
		.subresourceRange = { .aspectMask = aspect,
				.levelCount = p_use == ViewUse::SHADER ? desc.mip_count : 1,
				.baseArrayLayer = has_all_layers ? 0 : p_layer,
				.layerCount = has_all_layers ? desc.layer_count : 1 } };
	VkImageView view = VK_NULL_HANDLE;
	check(vkCreateImageView(device, &info, nullptr, &view), "vkCreateImageView");
	set_name(VK_OBJECT_TYPE_IMAGE_VIEW, view, desc.name);
	r_texture.views.push_back({ p_use, p_layer, p_is_arrayed, view });
	return view;
}

void VulkanDevice::destroy(TextureResource &r_texture) {
	for (const TextureView &view : r_texture.views) {
		vkDestroyImageView(device, view.view, nullptr);
	}
	r_texture.views.clear();
	if (!r_texture.is_swapchain) {
		vkDestroyImage(device, r_texture.image, nullptr);
	}
	allocator.free(r_texture.memory);
}

void VulkanDevice::destroy(SamplerResource &r_sampler) {
	vkDestroySampler(device, r_sampler.sampler, nullptr);
}

void VulkanDevice::destroy(MemoryResource &r_memory) {
	allocator.free(r_memory.memory);
}

TextureRID VulkanDevice::create_texture(const TextureDesc &p_desc) {
	fail_if_lost();
	TextureResource texture = make_image(p_desc);
	try {
		MemoryRequest request = { .kind = MemoryKind::GPU, .tiling = Tiling::OPTIMAL };
		vkGetImageMemoryRequirements(device, texture.image, &request.needs);
		texture.memory = allocate("texture '" + p_desc.name + "'", request);
		check(vkBindImageMemory(device, texture.image, texture.memory.block->memory,
					  texture.memory.offset_bytes),
				"vkBindImageMemory");
	} catch (...) {
		destroy(texture);
		throw;
	}
	return textures.add(std::move(texture));
}

TextureRID VulkanDevice::create_texture_with_data(
		TextureDesc p_desc, std::span<const uint8_t> p_bytes) {
	const uint64_t layer_bytes = compute_layer_bytes(p_desc);
	GNOMON_ASSERT(
			p_bytes.size() == layer_bytes || p_bytes.size() == layer_bytes * p_desc.layer_count,
			"texture '", p_desc.name, "' needs ", layer_bytes, " bytes per layer, got ",
			p_bytes.size());
	p_desc.usage = p_desc.usage | TextureUsage::SAMPLED | TextureUsage::COPY_TARGET;
	const TextureRID texture = create_texture(p_desc);
	try {
		add_texture_upload(texture, p_bytes);
	} catch (...) {
		free(texture);
		throw;
	}
	return texture;
}

void VulkanDevice::free(TextureRID p_texture) {
	TextureResource texture = textures.remove(p_texture);
	GNOMON_ASSERT(
			!texture.is_swapchain, "texture '", texture.desc.name, "' belongs to the swapchain");
	if (texture.placed_in) {
		--memories.get(texture.placed_in).texture_count;
	}
	drop_uploads(p_texture);
	defer_free(std::move(texture));
}

SamplerRID VulkanDevice::create_sampler(const SamplerDesc &p_desc) {
	fail_if_lost();
	const auto get_filter = [](Filter p_filter) {
		return p_filter == Filter::LINEAR ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
	};
	const auto get_address_mode = [](AddressMode p_mode) {
		return p_mode == AddressMode::REPEAT	? VK_SAMPLER_ADDRESS_MODE_REPEAT
				: p_mode == AddressMode::MIRROR ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
												: VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
	};
	const VkSamplerCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO,
		.magFilter = get_filter(p_desc.mag_filter),
		.minFilter = get_filter(p_desc.min_filter),
		.mipmapMode = p_desc.mip_mode == MipMode::LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR
														 : VK_SAMPLER_MIPMAP_MODE_NEAREST,
		.addressModeU = get_address_mode(p_desc.address_u),
		.addressModeV = get_address_mode(p_desc.address_v),
		.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
		// With a maximum of 0.25 only the first level is read. A maximum of 0 would disable the
		// minification filter.
		.maxLod = p_desc.mip_mode == MipMode::NONE ? 0.25f : VK_LOD_CLAMP_NONE };
	SamplerResource sampler{ p_desc, VK_NULL_HANDLE };
	check(vkCreateSampler(device, &info, nullptr, &sampler.sampler), "vkCreateSampler");
	set_name(VK_OBJECT_TYPE_SAMPLER, sampler.sampler, p_desc.name);
	return samplers.add(std::move(sampler));
}

void VulkanDevice::free(SamplerRID p_sampler) {
	defer_free(samplers.remove(p_sampler));
}

} // namespace gnomon
