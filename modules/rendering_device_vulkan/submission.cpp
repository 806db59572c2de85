#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"
#include "modules/rendering_device_vulkan/vulkan_swapchain.h"

#include <algorithm>
#include <new>
#include <utility>

namespace gnomon {

namespace {

void record_full_barrier(VkCommandBuffer p_commands, VkPipelineStageFlags2 p_target_stages,
		VkAccessFlags2 p_target_access) {
	const VkMemoryBarrier2 barrier = { .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
		.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
		.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
		.dstStageMask = p_target_stages,
		.dstAccessMask = p_target_access };
	const VkDependencyInfo dependency = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
		.memoryBarrierCount = 1,
		.pMemoryBarriers = &barrier };
	vkCmdPipelineBarrier2(p_commands, &dependency);
}

} // namespace

void VulkanDevice::create_slots() {
	const VkSemaphoreTypeCreateInfo timeline_info = {
		.sType = VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
		.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE
	};
	const VkSemaphoreCreateInfo semaphore_info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
		.pNext = &timeline_info };
	check(vkCreateSemaphore(device, &semaphore_info, nullptr, &timeline), "vkCreateSemaphore");
	set_name(VK_OBJECT_TYPE_SEMAPHORE, timeline, "finished submissions");
	check(vkCreateSemaphore(device, &semaphore_info, nullptr, &hang_semaphore),
			"vkCreateSemaphore");
	set_name(VK_OBJECT_TYPE_SEMAPHORE, hang_semaphore, "injected hang");
	for (uint32_t index = 0; index < SLOT_COUNT; ++index) {
		SubmissionSlot &slot = slots[index];
		const VkCommandPoolCreateInfo pool_info = {
			.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
			.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT |
					VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
			.queueFamilyIndex = physical.queue_family
		};
		check(vkCreateCommandPool(device, &pool_info, nullptr, &slot.pool), "vkCreateCommandPool");
		const VkCommandBufferAllocateInfo allocate_info = {
			.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
			.commandPool = slot.pool,
			.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
			.commandBufferCount = 2
		};
		VkCommandBuffer made[2];
		check(vkAllocateCommandBuffers(device, &allocate_info, made), "vkAllocateCommandBuffers");
		slot.commands = made[0];
		slot.uploads = made[1];
		set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, slot.commands, text("commands ", index));
		set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, slot.uploads, text("uploads ", index));
		slot.breadcrumbs = make_buffer({ .name = text("breadcrumbs ", index),
				.size_bytes = MAX_BREADCRUMBS * sizeof(uint32_t),
				.usage = BufferUsage::COPY_TARGET,
				.memory = MemoryKind::READBACK });
	}
}

void VulkanDevice::destroy_slots() {
	for (SubmissionSlot &slot : slots) {
		vkDestroyCommandPool(device, slot.pool, nullptr);
		for (VkDescriptorPool pool : slot.descriptor_pools) {
			vkDestroyDescriptorPool(device, pool, nullptr);
		}
		for (VkQueryPool pool : slot.query_pools) {
			vkDestroyQueryPool(device, pool, nullptr);
		}
		destroy(slot.breadcrumbs);
	}
	vkDestroySemaphore(device, timeline, nullptr);
	vkDestroySemaphore(device, hang_semaphore, nullptr);
}

uint64_t VulkanDevice::get_finished_number() {
	uint64_t finished = 0;
	check(vkGetSemaphoreCounterValue(device, timeline, &finished), "vkGetSemaphoreCounterValue");
	return finished;
}

void VulkanDevice::destroy_freed(uint64_t p_finished_number) {
	while (!deferred_frees.empty() &&
			deferred_frees.front().submission_number <= p_finished_number) {
		std::visit([&](auto &r_resource) { destroy(r_resource); }, deferred_frees.front().resource);
		deferred_frees.pop_front();
	}
}

void VulkanDevice::collect() {
	const uint64_t finished = get_finished_number();
	destroy_freed(finished);
	SubmissionSlot *newest = nullptr;
	for (SubmissionSlot &slot : slots) {
		const bool is_finished = slot.has_unread_spans && slot.number <= finished;
		if (is_finished && (!newest || slot.number > newest->number)) {
			newest = &slot;
		}
	}
	if (newest) {
		read_spans(*newest);
	}
}

template <typename Resource> void VulkanDevice::defer_free(Resource &&p_resource) {
	const uint64_t number = submitted_number + (recording.is_recording ? 1 : 0);
	deferred_frees.push_back({ number, std::move(p_resource) });
	// Must not throw, because destructors call it. A lost device keeps all resources until it is
	// destroyed.
	uint64_t finished = 0;
	if (lost_text.empty() &&
			vkGetSemaphoreCounterValue(device, timeline, &finished) == VK_SUCCESS) {
		destroy_freed(finished);
	}
}
template void VulkanDevice::defer_free(BufferResource &&);
template void VulkanDevice::defer_free(TextureResource &&);
template void VulkanDevice::defer_free(SamplerResource &&);
template void VulkanDevice::defer_free(MemoryResource &&);

CommandList &VulkanDevice::begin_commands() {
	fail_if_lost();
	GNOMON_ASSERT(!recording.is_recording,
			"begin_commands was called twice without submit_commands or abandon_commands.");
	SubmissionSlot &slot = get_recording_slot();
	// An abandoned recording, or one that failed to submit, leaves a number that was not submitted.
	wait_for(std::min(slot.number, submitted_number));
	collect();
	drop_read_backs(submitted_number);
	call_read_backs();
	check(vkResetCommandPool(device, slot.pool, 0), "vkResetCommandPool");
	for (VkDescriptorPool pool : slot.descriptor_pools) {
		vkResetDescriptorPool(device, pool, 0);
	}
	slot.descriptor_pool_index = 0;
	slot.span_names.clear();
	slot.has_unread_spans = false;
	slot.number = submitted_number + 1;
	check(vkBeginCommandBuffer(slot.commands, &BEGIN_INFO), "vkBeginCommandBuffer");
	// A full barrier orders the submissions. Inside a frame, the render graph records exact
	// barriers.
	record_full_barrier(slot.commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
			VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT);
	recording = VulkanCommandList();
	recording.device = this;
	recording.commands = slot.commands;
	recording.is_recording = true;
	return recording;
}

void VulkanDevice::submit_commands(SubmitMode p_mode) {
	fail_if_lost();
	GNOMON_ASSERT(recording.is_recording, "submit_commands without begin_commands.");
	GNOMON_ASSERT(!recording.is_rendering, "submit_commands before end_rendering.");
	GNOMON_ASSERT(!recording.is_conditional, "submit_commands before end_conditional.");
	GNOMON_ASSERT(!recording.is_in_span, "submit_commands inside span '",
			get_recording_slot().span_names.back(), "'.");
	submit();
	if (p_mode == SubmitMode::WAIT) {
		wait_for(submitted_number);
		collect();
		call_read_backs();
	}
}

bool VulkanDevice::apply_injected_fault(const SubmissionSlot &p_slot) {
	if (injected_fault.fault == Fault::SLOW_COMPILATION) {
		return false;
	}
	const std::optional<std::string> pass = injected_fault.find_pass(p_slot.span_names);
	if (!pass) {
		return false;
	}
	const Fault fault = std::exchange(injected_fault, {}).fault;
	if (fault == Fault::DEVICE_LOST) {
		fail_as_lost(describe_begun_span(*pass));
	}
	if (fault == Fault::OUT_OF_MEMORY) {
		throw std::bad_alloc(); // memory of the CPU
	}
	return fault == Fault::HANG;
}

void VulkanDevice::submit() {
	SubmissionSlot &slot = get_recording_slot();
	record_full_barrier(slot.commands, VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT);
	recording.is_recording = false;
	check(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
	const bool must_hang = apply_injected_fault(slot);
	std::vector<VkCommandBufferSubmitInfo> commands;
	if (!pending_uploads.empty()) {
		commands.push_back(record_uploads(slot));
	}
	commands.push_back({ .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
			.commandBuffer = slot.commands });

	const bool is_waiting = swapchain && swapchain->must_wait();
	const bool is_presenting = swapchain && swapchain->must_present();
	constexpr uint64_t BINARY = 0; // Vulkan ignores the value of a binary semaphore
	const auto make_semaphore_info = [](VkSemaphore p_semaphore, uint64_t p_value) {
		return VkSemaphoreSubmitInfo{ .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO,
			.semaphore = p_semaphore,
			.value = p_value,
			.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT };
	};
	std::vector<VkSemaphoreSubmitInfo> waits;
	if (is_waiting) {
		waits.push_back(make_semaphore_info(swapchain->get_acquire_semaphore(), BINARY));
	}
	if (must_hang) {
		waits.push_back(make_semaphore_info(hang_semaphore, /*p_value=*/1));
	}
	std::vector<VkSemaphoreSubmitInfo> signals = { make_semaphore_info(timeline, slot.number) };
	if (is_presenting) {
		signals.push_back(make_semaphore_info(swapchain->get_rendered_semaphore(), BINARY));
	}
	const VkSubmitInfo2 info = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
		.waitSemaphoreInfoCount = static_cast<uint32_t>(waits.size()),
		.pWaitSemaphoreInfos = waits.data(),
		.commandBufferInfoCount = static_cast<uint32_t>(commands.size()),
		.pCommandBufferInfos = commands.data(),
		.signalSemaphoreInfoCount = static_cast<uint32_t>(signals.size()),
		.pSignalSemaphoreInfos = signals.data() };
	check(vkQueueSubmit2(queue, 1, &info, VK_NULL_HANDLE), "vkQueueSubmit2");
	submitted_number = slot.number;
	slot.has_unread_spans = true;
	for (PendingUpload &upload : pending_uploads) {
		deferred_frees.push_back({ submitted_number, std::move(upload.staging) });
	}
	pending_uploads.clear();
	pending_upload_bytes = 0;
	if (is_waiting) {
		swapchain->is_acquisition_awaited = true;
	}
	if (is_presenting) {
		swapchain->present();
	}
}

void VulkanDevice::abandon_commands() {
	if (!recording.is_recording) {
		return;
	}
	// The command buffer stays open; begin_commands resets its pool.
	recording.is_recording = false;
	get_recording_slot().span_names.clear();
	drop_read_backs(submitted_number);
}

} // namespace gnomon
