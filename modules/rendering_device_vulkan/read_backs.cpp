// Asynchronous copies to the CPU.

#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

namespace gnomon {

BufferResource &VulkanDevice::add_read_back(
		const std::string &p_resource, uint64_t p_size_bytes, ReadBackCallback &&p_callback) {
	fail_if_lost();
	GNOMON_ASSERT(recording.is_recording, "read_back of ", p_resource,
			" outside begin_commands .. submit_commands");
	read_backs.push_back({ .submission_number = get_recording_slot().number,
			.staging = make_buffer({ .name = "read back " + p_resource,
					.size_bytes = p_size_bytes,
					.usage = BufferUsage::COPY_TARGET,
					.memory = MemoryKind::READBACK }),
			.callback = std::move(p_callback) });
	return read_backs.back().staging;
}

void VulkanDevice::read_back(BufferRID p_buffer, ReadBackCallback p_callback) {
	const BufferResource &source = buffers.get(p_buffer);
	const BufferResource &target =
			add_read_back(source.desc.name, source.desc.size_bytes, std::move(p_callback));
	recording.copy_buffer(source, target, source.desc.size_bytes, /*p_source_offset_bytes=*/0,
			/*p_target_offset_bytes=*/0);
}

void VulkanDevice::read_back(TextureRID p_texture, uint32_t p_layer, ReadBackCallback p_callback) {
	const TextureResource &source = textures.get(p_texture);
	const BufferResource &target = add_read_back(
			source.desc.name, compute_layer_bytes(source.desc), std::move(p_callback));
	recording.copy_texture_to_buffer(source, target, p_layer);
}

void VulkanDevice::call_read_backs() {
	const uint64_t finished = get_finished_number();
	while (!read_backs.empty() && read_backs.front().submission_number <= finished) {
		// Removed from the queue first, because the callback may throw or use the device.
		PendingReadBack read_back = std::move(read_backs.front());
		read_backs.pop_front();
		const Allocation &memory = read_back.staging.memory;
		const std::span bytes(memory.block->mapped + memory.offset_bytes,
				static_cast<size_t>(read_back.staging.desc.size_bytes));
		try {
			read_back.callback(bytes);
		} catch (...) {
			destroy(read_back.staging);
			throw;
		}
		destroy(read_back.staging);
	}
}

void VulkanDevice::drop_read_backs(uint64_t p_after_submission_number) {
	while (!read_backs.empty() && read_backs.back().submission_number > p_after_submission_number) {
		destroy(read_backs.back().staging);
		read_backs.pop_back();
	}
}

} // namespace gnomon
