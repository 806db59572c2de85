#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

namespace gnomon {

namespace {

constexpr uint32_t SPANS_PER_QUERY_POOL = 64; // with two timestamps each

} // namespace

void VulkanCommandList::begin_span(const std::string &p_name) {
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

void VulkanDevice::read_spans(SubmissionSlot &r_slot) {
	r_slot.has_unread_spans = false;
	gpu_spans.clear();
	for (uint32_t index = 0; index < r_slot.span_names.size(); ++index) {
		GpuSpan span{ r_slot.span_names[index], 0.0 };
		uint64_t times[2] = {};
		if (timestamp_mask != 0) {
			check(vkGetQueryPoolResults(device, r_slot.query_pools[index / SPANS_PER_QUERY_POOL],
						  2 * (index % SPANS_PER_QUERY_POOL), 2, sizeof(times), times,
						  sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
					"vkGetQueryPoolResults");
			// The mask keeps the difference correct if timestamps of less than 64 bits overflow.
			const uint64_t ticks = (times[1] - times[0]) & timestamp_mask;
			// timestampPeriod: nanoseconds per tick.
			span.gpu_ms = static_cast<double>(ticks) * limits.timestampPeriod * 1e-6;
		}
		gpu_spans.push_back(std::move(span));
	}
}

} // namespace gnomon
