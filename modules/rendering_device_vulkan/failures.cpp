#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <algorithm>

namespace gnomon {

namespace {

constexpr size_t NAMED_RESOURCE_COUNT = 3; // named when memory is exhausted

std::string describe_bytes(uint64_t p_bytes) {
	constexpr uint64_t KIB = 1024;
	constexpr uint64_t MIB = KIB * KIB;
	// From 16 units on, so that rounding down loses less than 1/16.
	if (p_bytes < 16 * KIB) {
		return text(p_bytes, " bytes");
	}
	return p_bytes < 16 * MIB ? text(p_bytes / KIB, " KiB") : text(p_bytes / MIB, " MiB");
}

} // namespace

void VulkanDevice::check(VkResult p_result, const char *p_call) {
	if (p_result >= 0) {
		return;
	}
	if (p_result == VK_ERROR_DEVICE_LOST) {
		fail_as_lost(describe_last_span());
	}
	fail(p_call, " failed on device \"", physical.info.name, "\": ", get_result_name(p_result),
			". Lower the map size or the image size, or choose another device with --device.");
}

void VulkanDevice::fail_if_lost() const {
	if (!lost_text.empty()) {
		throw DeviceLost(lost_text);
	}
}

void VulkanDevice::fail_as_lost(const std::string &p_where) {
	if (lost_text.empty()) {
		lost_text = text("The device was lost ", p_where,
				". Restart the program; if it happens again, lower the map size or the image size, "
				"update the driver, or choose another device with --device.");
	}
	throw DeviceLost(lost_text);
}

std::string VulkanDevice::describe_begun_span(const std::string &p_span_name) {
	return text("in pass '", p_span_name, "' (last pass that began)");
}

std::string VulkanDevice::describe_last_span() const {
	// Newest submission first; the memory of the breadcrumbs stays readable after the loss.
	const SubmissionSlot *ordered[SLOT_COUNT] = { &slots[0], &slots[1] };
	if (ordered[0]->number < ordered[1]->number) {
		std::swap(ordered[0], ordered[1]);
	}
	for (const SubmissionSlot *slot : ordered) {
		if (const size_t begun_count = count_begun_spans(*slot); begun_count > 0) {
			return describe_begun_span(slot->span_names[begun_count - 1]);
		}
	}
	// No breadcrumb was written.
	for (const SubmissionSlot *slot : ordered) {
		if (!slot->span_names.empty()) {
			return text("(no pass is known to have begun; the last recorded one is '",
					slot->span_names.back(), "')");
		}
	}
	return "before any pass was recorded";
}

std::vector<LiveResource> VulkanDevice::find_live_resources() {
	std::vector<LiveResource> found;
	const auto add = [&](const char *p_kind, const std::string &p_name, uint64_t p_size_bytes) {
		found.push_back({ text(p_kind, " '", p_name, "'"), p_size_bytes });
	};
	buffers.for_each([&](BufferRID, const BufferResource &p_buffer) {
		add("buffer", p_buffer.desc.name, p_buffer.memory.size_bytes);
	});
	textures.for_each([&](TextureRID, const TextureResource &p_texture) {
		if (!p_texture.is_swapchain) {
			add("texture", p_texture.desc.name, p_texture.memory.size_bytes);
		}
	});
	samplers.for_each([&](SamplerRID, const SamplerResource &p_sampler) {
		add("sampler", p_sampler.desc.name, 0);
	});
	memories.for_each([&](MemoryRID, const MemoryResource &p_memory) {
		add("memory", p_memory.desc.name, p_memory.memory.size_bytes);
	});
	std::ranges::sort(found, {}, &LiveResource::name);
	return found;
}

void VulkanDevice::fail_out_of_memory(
		const std::string &p_resource, const MemoryRequest &p_request) {
	std::vector<LiveResource> consumers = find_live_resources();
	std::erase_if(consumers, [](const LiveResource &p_live) { return p_live.size_bytes == 0; });
	std::ranges::stable_sort(consumers, std::greater(), &LiveResource::size_bytes);
	std::string largest;
	for (size_t index = 0; index < std::min(consumers.size(), NAMED_RESOURCE_COUNT); ++index) {
		largest += text(largest.empty() ? "; the largest are " : ", ", consumers[index].name, " ",
				describe_bytes(consumers[index].size_bytes));
	}
	const uint32_t type =
			allocator.find_memory_type(p_request.needs.memoryTypeBits, p_request.kind);
	fail("Out of device memory: ", p_resource, " needs ", describe_bytes(p_request.needs.size),
			", ", describe_bytes(allocator.get_use().used_bytes), " of ",
			describe_bytes(allocator.compute_budget_bytes(type)), " are in use", largest,
			". Lower the map size, the layer count or the image size, or choose another device ",
			"with --device.");
}

void VulkanDevice::set_name_of(VkObjectType p_type, uint64_t p_handle, const std::string &p_name) {
	if (!set_object_name) {
		return;
	}
	const VkDebugUtilsObjectNameInfoEXT info = {
		.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
		.objectType = p_type,
		.objectHandle = p_handle,
		.pObjectName = p_name.c_str()
	};
	set_object_name(device, &info);
}

} // namespace gnomon
