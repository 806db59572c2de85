#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

namespace {

// Limits the staging memory while a scene loads: once this much is pending, it is submitted.
constexpr uint64_t MAX_PENDING_BYTES = uint64_t(64) << 20;

VkImageMemoryBarrier2 make_upload_barrier(const TextureResource &p_texture) {
	return { .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
		.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
		.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
		.image = p_texture.image,
		.subresourceRange = { .aspectMask = get_aspect(p_texture.desc.format),
				.levelCount = p_texture.desc.mip_count,
				.layerCount = p_texture.desc.layer_count } };
}

void record_image_barriers(
		VkCommandBuffer p_commands, const std::vector<VkImageMemoryBarrier2> &p_barriers) {
	const VkDependencyInfo dependency = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
		.imageMemoryBarrierCount = static_cast<uint32_t>(p_barriers.size()),
		.pImageMemoryBarriers = p_barriers.data() };
	vkCmdPipelineBarrier2(p_commands, &dependency);
}

} // namespace

BufferResource VulkanDevice::make_staging(
		const std::string &p_name, std::span<const uint8_t> p_bytes) {
	BufferResource staging = make_buffer({ .name = "upload of " + p_name,
			.size_bytes = p_bytes.size(),
			.usage = BufferUsage::COPY_SOURCE,
			.memory = MemoryKind::UPLOAD });
	std::memcpy(staging.memory.block->mapped + staging.memory.offset_bytes, p_bytes.data(),
			p_bytes.size());
	return staging;
}

void VulkanDevice::add_buffer_upload(BufferRID p_buffer, std::span<const uint8_t> p_bytes) {
	const std::string &name = buffers.get(p_buffer).desc.name;
	for (uint64_t offset = 0; offset < p_bytes.size(); offset += MAX_PENDING_BYTES) {
		const uint64_t size = std::min<uint64_t>(MAX_PENDING_BYTES, p_bytes.size() - offset);
		pending_uploads.push_back({ .staging = make_staging(name, p_bytes.subspan(offset, size)),
				.size_bytes = size,
				.buffer = p_buffer,
				.buffer_offset_bytes = offset });
		pending_upload_bytes += size;
		flush_uploads_when_many();
	}
}

void VulkanDevice::add_texture_upload(TextureRID p_texture, std::span<const uint8_t> p_bytes) {
	TextureResource &texture = textures.get(p_texture);
	pending_uploads.push_back({ .staging = make_staging(texture.desc.name, p_bytes),
			.size_bytes = p_bytes.size(),
			.texture = p_texture,
			.layer_count =
					static_cast<uint32_t>(p_bytes.size() / compute_layer_bytes(texture.desc)) });
	pending_upload_bytes += p_bytes.size();
	texture.recorded_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
	flush_uploads_when_many();
}

VkCommandBufferSubmitInfo VulkanDevice::record_uploads(const SubmissionSlot &p_slot) {
	const VkCommandBuffer commands = p_slot.uploads;
	check(vkBeginCommandBuffer(commands, &BEGIN_INFO), "vkBeginCommandBuffer");
	std::vector<VkImageMemoryBarrier2> barriers;
	for (const PendingUpload &upload : pending_uploads) {
		if (upload.texture) {
			VkImageMemoryBarrier2 &barrier =
					barriers.emplace_back(make_upload_barrier(textures.get(upload.texture)));
			// For the layout only: memory of a freed resource is used again after its submission
			// has finished (defer_free), so that no earlier command needs to be waited for.
			barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
			barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
			barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
			barrier.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
			barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
		}
	}
	if (!barriers.empty()) {
		record_image_barriers(commands, barriers);
	}
	for (const PendingUpload &upload : pending_uploads) {
		if (upload.texture) {
			const TextureResource &texture = textures.get(upload.texture);
			const TextureDesc &desc = texture.desc;
			std::vector<VkBufferImageCopy> regions;
			VkDeviceSize offset_bytes = 0;
			// Textures have several mip levels or several layers, not both: see TextureDesc.
			for (uint32_t level = 0; level < desc.mip_count; ++level) {
				const glm::uvec2 size_px = compute_mip_size(desc.size_px, level);
				regions.push_back({ .bufferOffset = offset_bytes,
						.imageSubresource = { .aspectMask = get_aspect(desc.format),
								.mipLevel = level,
								.layerCount = upload.layer_count },
						.imageExtent = { size_px.x, size_px.y, 1 } });
				offset_bytes +=
						VkDeviceSize(size_px.x) * size_px.y * get_texel_size_bytes(desc.format);
			}
			vkCmdCopyBufferToImage(commands, upload.staging.buffer, texture.image,
					VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, static_cast<uint32_t>(regions.size()),
					regions.data());
		} else {
			const VkBufferCopy region = { .dstOffset = upload.buffer_offset_bytes,
				.size = upload.size_bytes };
			vkCmdCopyBuffer(
					commands, upload.staging.buffer, buffers.get(upload.buffer).buffer, 1, &region);
		}
	}
	for (VkImageMemoryBarrier2 &barrier : barriers) {
		barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
		barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
		barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
		barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
		barrier.oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
		barrier.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
	}
	const VkMemoryBarrier2 memory = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
		.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
		.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT,
		.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
		.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT };
	const VkDependencyInfo dependency = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
		.memoryBarrierCount = 1,
		.pMemoryBarriers = &memory,
		.imageMemoryBarrierCount = static_cast<uint32_t>(barriers.size()),
		.pImageMemoryBarriers = barriers.data() };
	vkCmdPipelineBarrier2(commands, &dependency);
	check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
	return { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, .commandBuffer = commands };
}

void VulkanDevice::flush_uploads_when_many() {
	if (pending_upload_bytes < MAX_PENDING_BYTES) {
		return;
	}
	// Makes a separate submission and waits for it. It runs before the commands recorded so far, as
	// uploads that are submitted with those commands would.
	SubmissionSlot &slot = get_recording_slot();
	// The slot's command buffers can be reused after this. If earlier work hangs, it throws
	// DeviceLost, while vkQueueWaitIdle has no time limit.
	wait_for(submitted_number);
	const VkCommandBufferSubmitInfo commands_info = record_uploads(slot);
	const VkSubmitInfo2 submit_info = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
		.commandBufferInfoCount = 1,
		.pCommandBufferInfos = &commands_info };
	VkResult result = vkQueueSubmit2(queue, 1, &submit_info, VK_NULL_HANDLE);
	if (result == VK_SUCCESS) {
		result = vkQueueWaitIdle(queue);
	}
	for (PendingUpload &upload : pending_uploads) {
		destroy(upload.staging);
	}
	pending_uploads.clear();
	pending_upload_bytes = 0;
	check(result, "vkQueueSubmit2, vkQueueWaitIdle");
}

template <typename Handle> void VulkanDevice::drop_uploads(Handle p_target) {
	std::erase_if(pending_uploads, [&](PendingUpload &r_upload) {
		bool is_target = false;
		if constexpr (std::is_same_v<Handle, BufferRID>) {
			is_target = r_upload.buffer == p_target;
		} else {
			is_target = r_upload.texture == p_target;
		}
		if (is_target) {
			pending_upload_bytes -= r_upload.size_bytes;
			destroy(r_upload.staging);
		}
		return is_target;
	});
}
template void VulkanDevice::drop_uploads(BufferRID);
template void VulkanDevice::drop_uploads(TextureRID);

} // namespace gnomon
