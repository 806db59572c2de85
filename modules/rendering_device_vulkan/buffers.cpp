#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

#include <limits>

namespace gnomon {

namespace {

/// Largest size of buffers with one of the usages.
struct Limit {
	BufferUsage usage;
	uint64_t max_bytes;
	const char *what; // such a buffer, in messages
};

} // namespace

Allocation VulkanDevice::allocate(const std::string &p_resource, const MemoryRequest &p_request) {
	Allocation allocation = allocator.allocate(p_request);
	if (!allocation.block && !deferred_frees.empty()) {
		// The GPU may still use the memory of freed resources: wait for it and try again.
		wait_for(submitted_number);
		collect();
		allocation = allocator.allocate(p_request);
	}
	if (!allocation.block) {
		fail_out_of_memory(p_resource, p_request);
	}
	return allocation;
}

BufferResource VulkanDevice::make_buffer(const BufferDesc &p_desc) {
	GNOMON_ASSERT(p_desc.size_bytes > 0, "buffer '", p_desc.name, "' has no bytes");
	if (!features.storage_and_texel_buffers && has_usage(p_desc.usage, BufferUsage::STORAGE) &&
			has_usage(p_desc.usage, BufferUsage::TEXEL)) {
		fail("Buffer '", p_desc.name, "' is STORAGE and TEXEL at once, which device \"",
				physical.info.name,
				"\" lacks (DeviceFeatures::storage_and_texel_buffers). Use STORAGE alone, and a "
				"shader that reads it as a storage buffer.");
	}
	const uint64_t texel_bytes = get_texel_size_bytes(p_desc.texel_format);
	constexpr uint64_t NO_LIMIT = std::numeric_limits<uint64_t>::max();
	const Limit buffer_limits[] = {
		{ BufferUsage::STORAGE, limits.maxStorageBufferRange, "a storage buffer" },
		{ BufferUsage::UNIFORM, limits.maxUniformBufferRange, "a uniform buffer" },
		{ BufferUsage::TEXEL, limits.maxTexelBufferElements * texel_bytes, "a texel buffer" },
		{ p_desc.usage, max_buffer_bytes > 0 ? max_buffer_bytes : NO_LIMIT, "a buffer" },
	};
	for (const Limit &limit : buffer_limits) {
		if (has_usage(p_desc.usage, limit.usage) && p_desc.size_bytes > limit.max_bytes) {
			fail("Buffer '", p_desc.name, "' has ", p_desc.size_bytes, " bytes; ", limit.what,
					" has at most ", limit.max_bytes, " on device \"", physical.info.name,
					"\". Use a smaller scene or map, or choose another device with --device.");
		}
	}
	BufferResource buffer;
	buffer.desc = p_desc;
	const VkBufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
		.size = p_desc.size_bytes,
		.usage = get_vulkan_usage(p_desc.usage) };
	check(vkCreateBuffer(device, &info, nullptr, &buffer.buffer), "vkCreateBuffer");
	try {
		MemoryRequest request = { .kind = p_desc.memory, .tiling = Tiling::LINEAR };
		vkGetBufferMemoryRequirements(device, buffer.buffer, &request.needs);
		buffer.memory = allocate("buffer '" + p_desc.name + "'", request);
		check(vkBindBufferMemory(device, buffer.buffer, buffer.memory.block->memory,
					  buffer.memory.offset_bytes),
				"vkBindBufferMemory");
		// Memory that the host cannot reach is not filled: tests use a software driver.
		if (uint8_t *const mapped = buffer.memory.block->mapped; memory_pattern && mapped) {
			fill_memory({ mapped + buffer.memory.offset_bytes, p_desc.size_bytes }, *memory_pattern,
					random_memory);
		}
		set_name(VK_OBJECT_TYPE_BUFFER, buffer.buffer, p_desc.name);
		if (has_usage(p_desc.usage, BufferUsage::TEXEL)) {
			const VkBufferViewCreateInfo view_info = {
				.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
				.buffer = buffer.buffer,
				.format = get_vulkan_format(p_desc.texel_format),
				.range = p_desc.size_bytes / texel_bytes * texel_bytes
			};
			check(vkCreateBufferView(device, &view_info, nullptr, &buffer.texel_view),
					"vkCreateBufferView");
			set_name(VK_OBJECT_TYPE_BUFFER_VIEW, buffer.texel_view, p_desc.name);
		}
	} catch (...) {
		destroy(buffer);
		throw;
	}
	return buffer;
}

void VulkanDevice::destroy(BufferResource &r_buffer) {
	vkDestroyBufferView(device, r_buffer.texel_view, nullptr);
	vkDestroyBuffer(device, r_buffer.buffer, nullptr);
	allocator.free(r_buffer.memory);
}

BufferRID VulkanDevice::create_buffer(const BufferDesc &p_desc) {
	fail_if_lost();
	return buffers.add(make_buffer(p_desc));
}

BufferRID VulkanDevice::create_buffer_with_data(
		BufferDesc p_desc, std::span<const uint8_t> p_bytes) {
	fail_if_lost();
	GNOMON_ASSERT(p_bytes.size() <= p_desc.size_bytes, "buffer '", p_desc.name, "' of ",
			p_desc.size_bytes, " bytes gets ", p_bytes.size(), " bytes of data");
	p_desc.usage = p_desc.usage | BufferUsage::COPY_TARGET;
	p_desc.memory = MemoryKind::GPU;
	const BufferRID buffer = buffers.add(make_buffer(p_desc));
	try {
		add_buffer_upload(buffer, p_bytes);
	} catch (...) {
		free(buffer);
		throw;
	}
	return buffer;
}

void VulkanDevice::free(BufferRID p_buffer) {
	BufferResource buffer = buffers.remove(p_buffer);
	drop_uploads(p_buffer);
	defer_free(std::move(buffer));
}

uint8_t *VulkanDevice::get_mapped(BufferRID p_buffer) {
	const BufferResource &buffer = buffers.get(p_buffer);
	GNOMON_ASSERT(buffer.desc.memory != MemoryKind::GPU, "buffer '", buffer.desc.name,
			"' is in GPU memory, which is not mapped");
	return buffer.memory.block->mapped + buffer.memory.offset_bytes;
}

} // namespace gnomon
