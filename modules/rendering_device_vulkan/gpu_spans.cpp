#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t SPANS_PER_QUERY_POOL = 64; // with two timestamps each

} // namespace

void VulkanCommandList::begin_span(const std::string &p_name, bool /*p_needs_time*/) {
	check_recording("begin_span");
	GNOMON_ASSERT(!is_in_span && !is_rendering, "span '", p_name,
			"' begins inside another or inside begin_rendering .. end_rendering");
	is_in_span = true;
	SubmissionSlot &slot = device->get_recording_slot();
	const uint32_t index = static_cast<uint32_t>(slot.span_names.size());
	slot.span_names.push_back(p_name);
	if (device->begin_label) {
		const VkDebugUtilsLabelEXT label = { .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT,
			.pLabelName = p_name.c_str() };
		device->begin_label(commands, &label);
	}
	if (index < VulkanDevice::MAX_BREADCRUMBS) {
		vkCmdFillBuffer(commands, slot.breadcrumbs.buffer, index * sizeof(uint32_t),
				sizeof(uint32_t), static_cast<uint32_t>(slot.number));
	}
	if (device->timestamp_mask == 0) {
		return;
	}
	const uint32_t pool_index = index / SPANS_PER_QUERY_POOL;
	if (pool_index == slot.query_pools.size()) {
		const VkQueryPoolCreateInfo info = { .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
			.queryType = VK_QUERY_TYPE_TIMESTAMP,
			.queryCount = 2 * SPANS_PER_QUERY_POOL };
		VkQueryPool pool = VK_NULL_HANDLE;
		device->check(
				vkCreateQueryPool(device->device, &info, nullptr, &pool), "vkCreateQueryPool");
		device->set_name(VK_OBJECT_TYPE_QUERY_POOL, pool, "span times");
		slot.query_pools.push_back(pool);
	}
	const VkQueryPool pool = slot.query_pools[pool_index];
	const uint32_t index_in_pool = index % SPANS_PER_QUERY_POOL;
	if (index_in_pool == 0) {
		vkCmdResetQueryPool(commands, pool, 0, 2 * SPANS_PER_QUERY_POOL);
	}
	// "All commands" at both ends: a span begins when all commands before it are done, so that the
	// spans of a frame do not overlap and their times can be added.
	vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool, 2 * index_in_pool);
}

void VulkanCommandList::end_span() {
	check_recording("end_span");
	GNOMON_ASSERT(is_in_span && !is_rendering && !is_conditional,
			"end_span without begin_span, or before end_rendering or end_conditional");
	is_in_span = false;
	SubmissionSlot &slot = device->get_recording_slot();
	const uint32_t index = static_cast<uint32_t>(slot.span_names.size()) - 1;
	if (device->timestamp_mask != 0) {
		vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
				slot.query_pools[index / SPANS_PER_QUERY_POOL],
				2 * (index % SPANS_PER_QUERY_POOL) + 1);
	}
	if (device->end_label) {
		device->end_label(commands);
	}
}

std::vector<uint64_t> VulkanDevice::read_timestamps(VkQueryPool p_pool, uint32_t p_count) {
	std::vector<uint64_t> times(p_count);
	// Without waiting: the submission has ended, so that all times are available. A wait for one
	// that never becomes available would stop the program without a message.
	const VkResult result =
			vkGetQueryPoolResults(device, p_pool, 0, p_count, times.size() * sizeof(uint64_t),
					times.data(), sizeof(uint64_t), VK_QUERY_RESULT_64_BIT);
	check(result, "vkGetQueryPoolResults");
	if (result == VK_NOT_READY) {
		log_warning("Device \"", physical.info.name,
				"\" has no times of a frame that has ended; they are reported as 0 ms. Update the "
				"driver.");
		return std::vector<uint64_t>(p_count, 0);
	}
	return times;
}

void VulkanDevice::read_spans(SubmissionSlot &r_slot) {
	r_slot.has_unread_spans = false;
	gpu_spans.clear();
	const auto span_count = static_cast<uint32_t>(r_slot.span_names.size());
	std::vector<uint64_t> times; // two for each span
	for (uint32_t first = 0; timestamp_mask != 0 && first < span_count;
			first += SPANS_PER_QUERY_POOL) {
		const std::vector<uint64_t> pool_times =
				read_timestamps(r_slot.query_pools[first / SPANS_PER_QUERY_POOL],
						2 * std::min(SPANS_PER_QUERY_POOL, span_count - first));
		times.insert(times.end(), pool_times.begin(), pool_times.end());
	}
	times.resize(2 * size_t(span_count));
	for (size_t index = 0; index < span_count; ++index) {
		// The mask keeps the difference correct if timestamps of less than 64 bits overflow.
		const uint64_t ticks = (times[2 * index + 1] - times[2 * index]) & timestamp_mask;
		// timestampPeriod: nanoseconds per tick.
		const double gpu_ms = static_cast<double>(ticks) * limits.timestampPeriod * 1e-6;
		gpu_spans.push_back({ r_slot.span_names[index], gpu_ms });
	}
}

} // namespace gnomon
