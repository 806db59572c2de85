#include "modules/rendering_device/command_list.h"

#include "modules/core/error.h"
#include "modules/rendering_device/work_groups.h"
#include "modules/rendering_device_vulkan/access.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

void VulkanCommandList::check_recording(const char *p_call) const {
	GNOMON_ASSERT(is_recording, p_call, " outside begin_commands .. submit_commands");
}

void VulkanCommandList::push_barrier(const Barrier &p_barrier,
		std::vector<VkBufferMemoryBarrier2> &r_buffers,
		std::vector<VkImageMemoryBarrier2> &r_images) {
	const Dependency dependency = compute_dependency(p_barrier);
	const auto add_masks = [&](auto p_info) {
		p_info.srcStageMask = dependency.source_stages;
		p_info.srcAccessMask = dependency.source_access;
		p_info.dstStageMask = dependency.target_stages;
		p_info.dstAccessMask = dependency.target_access;
		p_info.srcQueueFamilyIndex = p_info.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
		return p_info;
	};
	if (p_barrier.texture) {
		TextureResource &texture = device->textures.get(p_barrier.texture);
		GNOMON_ASSERT(dependency.new_layout != VK_IMAGE_LAYOUT_UNDEFINED, "texture '",
				texture.desc.name, "' cannot have access ", static_cast<int>(p_barrier.after));
		const Format format = texture.desc.format;
		texture.recorded_layout = get_layout_for_format(dependency.new_layout, format);
		if (dependency.is_needed) {
			r_images.push_back(add_masks(
					VkImageMemoryBarrier2{ .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
							.oldLayout = get_layout_for_format(dependency.old_layout, format),
							.newLayout = texture.recorded_layout,
							.image = texture.image,
							.subresourceRange = { .aspectMask = get_aspect(format),
									.levelCount = VK_REMAINING_MIP_LEVELS,
									.layerCount = VK_REMAINING_ARRAY_LAYERS } }));
		}
	} else {
		const BufferResource &buffer = device->buffers.get(p_barrier.buffer);
		if (dependency.is_needed) {
			r_buffers.push_back(add_masks(
					VkBufferMemoryBarrier2{ .sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2,
							.buffer = buffer.buffer,
							.size = VK_WHOLE_SIZE }));
		}
	}
}

void VulkanCommandList::barriers(std::span<const Barrier> p_barriers) {
	check_recording("barriers");
	GNOMON_ASSERT(!is_rendering, "barriers inside begin_rendering .. end_rendering");
	std::vector<VkBufferMemoryBarrier2> buffers;
	std::vector<VkImageMemoryBarrier2> images;
	for (const Barrier &barrier : p_barriers) {
		push_barrier(barrier, buffers, images);
	}
	if (buffers.empty() && images.empty()) {
		return;
	}
	const VkDependencyInfo info = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
		.bufferMemoryBarrierCount = static_cast<uint32_t>(buffers.size()),
		.pBufferMemoryBarriers = buffers.data(),
		.imageMemoryBarrierCount = static_cast<uint32_t>(images.size()),
		.pImageMemoryBarriers = images.data() };
	vkCmdPipelineBarrier2(commands, &info);
}

void VulkanCommandList::bind_pipeline(PipelineRID p_pipeline) {
	check_recording("bind_pipeline");
	const PipelineResource &pipeline = device->get_pipeline(p_pipeline);
	if (bound_pipeline == &pipeline) {
		return;
	}
	bound_pipeline = &pipeline;
	are_resources_bound = false;
	are_constants_pushed = false;
	vkCmdBindPipeline(commands, pipeline.bind_point, pipeline.pipeline);
}

void VulkanCommandList::push_constants(std::span<const uint8_t> p_bytes) {
	check_recording("push_constants");
	GNOMON_ASSERT(bound_pipeline, "push_constants before bind_pipeline");
	const PipelineResource &pipeline = *bound_pipeline;
	// A C++ block may be padded to 16 bytes or, as in GLSL, end with its last member.
	const size_t padded_bytes = (p_bytes.size() + 15) / 16 * 16;
	GNOMON_ASSERT(padded_bytes == pipeline.push_constant_bytes && p_bytes.size() % 4 == 0,
			"pipeline '", pipeline.name, "' has ", pipeline.push_constant_bytes,
			" bytes of push constants, got ", p_bytes.size());
	vkCmdPushConstants(commands, pipeline.layout, pipeline.push_constant_stages, 0,
			static_cast<uint32_t>(p_bytes.size()), p_bytes.data());
	are_constants_pushed = true;
}

void VulkanCommandList::check_bound(const char *p_call) const {
	check_recording(p_call);
	GNOMON_ASSERT(bound_pipeline, p_call, " before bind_pipeline");
	GNOMON_ASSERT(are_resources_bound || !bound_pipeline->uses_resources, p_call, ": pipeline '",
			bound_pipeline->name, "' has no resources bound");
	GNOMON_ASSERT(are_constants_pushed || bound_pipeline->push_constant_bytes == 0, p_call,
			": pipeline '", bound_pipeline->name, "' has no push constants");
}

void VulkanCommandList::check_dispatch(const char *p_call) const {
	check_bound(p_call);
	GNOMON_ASSERT(!is_rendering, p_call, " inside begin_rendering .. end_rendering");
	GNOMON_ASSERT(bound_pipeline->bind_point == VK_PIPELINE_BIND_POINT_COMPUTE, p_call,
			" with raster pipeline '", bound_pipeline->name, "'");
}

void VulkanCommandList::dispatch(glm::uvec3 p_group_count) {
	check_dispatch("dispatch");
	const uint32_t *limits = device->limits.maxComputeWorkGroupCount;
	GNOMON_ASSERT(p_group_count.x <= limits[0] && p_group_count.y <= limits[1] &&
					p_group_count.z <= limits[2],
			"pipeline '", bound_pipeline->name, "': ", p_group_count.x, " x ", p_group_count.y,
			" x ", p_group_count.z, " groups, at most ", limits[0], " x ", limits[1], " x ",
			limits[2]);
	++device->command_counts.dispatches;
	vkCmdDispatch(commands, p_group_count.x, p_group_count.y, p_group_count.z);
}

void VulkanCommandList::dispatch_items(glm::uvec3 p_item_count) {
	check_dispatch("dispatch_items");
	const glm::uvec3 local_size = bound_pipeline->local_size;
	dispatch(arrange_work_groups((p_item_count + local_size - 1u) / local_size));
}

void VulkanCommandList::dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) {
	check_dispatch("dispatch_indirect");
	++device->command_counts.dispatches;
	vkCmdDispatchIndirect(commands, device->buffers.get(p_arguments).buffer, p_offset_bytes);
}

} // namespace gnomon
