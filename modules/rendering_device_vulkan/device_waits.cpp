// Waits for the device with a timeout. If the device does not respond, the resources that it may be
// using are not destroyed.

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <algorithm>
#include <atomic>
#include <chrono>

namespace gnomon {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double PROGRESS_CHECK_INTERVAL_S = 1.0;
constexpr double FINAL_WAIT_S = 2.0; // last wait for a hung device, before it is leaked

std::atomic<bool> has_hung_device = false;

} // namespace

size_t VulkanDevice::count_begun_spans(const SubmissionSlot &p_slot) const {
	if (!p_slot.breadcrumbs.memory.block) {
		return 0;
	}
	const volatile auto *words = reinterpret_cast<const volatile uint32_t *>(
			p_slot.breadcrumbs.memory.block->mapped + p_slot.breadcrumbs.memory.offset_bytes);
	const size_t count = std::min<size_t>(p_slot.span_names.size(), MAX_BREADCRUMBS);
	size_t begun_count = 0;
	while (begun_count < count && words[begun_count] == static_cast<uint32_t>(p_slot.number)) {
		++begun_count;
	}
	return begun_count;
}

VkResult VulkanDevice::wait_at_most(uint64_t p_submission_number, double p_seconds) {
	const VkSemaphoreWaitInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO,
		.semaphoreCount = 1,
		.pSemaphores = &timeline,
		.pValues = &p_submission_number };
	return vkWaitSemaphores(device, &info, static_cast<uint64_t>(p_seconds * 1e9));
}

void VulkanDevice::wait_for(uint64_t p_submission_number) {
	// A pass that begins is progress too, so that a frame of many slow passes does not time out.
	const auto get_progress = [&] {
		size_t begun_count = 0;
		for (const SubmissionSlot &slot : slots) {
			begun_count += count_begun_spans(slot);
		}
		return std::pair(get_finished_number(), begun_count);
	};
	// A quarter of a short limit, so that the wait does not exceed it by much.
	const double check_interval_s = wait_limit_s > 0
			? std::min(PROGRESS_CHECK_INTERVAL_S, wait_limit_s / 4)
			: PROGRESS_CHECK_INTERVAL_S;
	std::optional<std::pair<uint64_t, size_t>> last_progress;
	Clock::time_point last_progress_time = Clock::now();
	while (true) {
		const VkResult result = wait_at_most(p_submission_number, check_interval_s);
		if (result != VK_TIMEOUT) {
			check(result, "vkWaitSemaphores");
			return;
		}
		const auto progress = get_progress();
		if (progress != last_progress) {
			last_progress = progress;
			last_progress_time = Clock::now();
		}
		const std::chrono::duration<double> stalled = Clock::now() - last_progress_time;
		if (wait_limit_s > 0 && stalled.count() >= wait_limit_s) {
			fail_as_hung(progress.first);
		}
	}
}

void VulkanDevice::fail_as_hung(uint64_t p_finished_number) {
	const SubmissionSlot *stuck = nullptr; // the oldest that has not ended
	for (const SubmissionSlot &slot : slots) {
		if (slot.number > p_finished_number && slot.number <= submitted_number &&
				(!stuck || slot.number < stuck->number)) {
			stuck = &slot;
		}
	}
	std::string where = "before any pass began";
	if (stuck && !stuck->span_names.empty()) {
		const size_t begun_count = count_begun_spans(*stuck);
		where = begun_count > 0 ? describe_begun_span(stuck->span_names[begun_count - 1])
								: text("before pass '", stuck->span_names.front(), "' began");
	}
	is_hung = true;
	lost_text = text("The device has made no progress for ", wait_limit_s, " s, ", where,
			". Lower the map size or the image size, choose another device with --device, or let "
			"it take longer: GNOMON_DEVICE_TIMEOUT_S is the limit in seconds, 0 = none.");
	throw DeviceLost(lost_text);
}

bool VulkanDevice::try_wait_idle() {
	if (timeline && !is_hung && lost_text.empty()) {
		try {
			wait_for(submitted_number);
		} catch (const std::exception &error) {
			log_error(error.what());
		}
	}
	if (is_hung && wait_at_most(submitted_number, FINAL_WAIT_S) != VK_SUCCESS) {
		has_hung_device = true;
		return false;
	}
	is_hung = false;
	vkDeviceWaitIdle(device); // also after a loss, where it returns at once
	return true;
}

bool has_device_hung() {
	return has_hung_device;
}

void VulkanDevice::wait_idle() {
	fail_if_lost();
	wait_for(submitted_number);
	check(vkDeviceWaitIdle(device), "vkDeviceWaitIdle");
	collect();
	if (!recording.is_recording) {
		drop_read_backs(submitted_number);
		call_read_backs();
	}
}

} // namespace gnomon
