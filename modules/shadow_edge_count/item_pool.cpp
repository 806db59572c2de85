#include "modules/shadow_edge_count/item_pool.h"

#include "modules/core/error.h"
#include "modules/core/text.h"
#include "modules/rendering_device/command_list.h"
#include "modules/shadows/fetched_buffers.h"

#include <algorithm>
#include <cstring>
#include <optional>

namespace gnomon {

namespace {

// An existing buffer grows by at least a quarter, so that meshes that are added one after another
// seldom copy it. The first one is as large as what was added before it was needed.
constexpr uint64_t GROWTH_DIVISOR = 4;

// Limits the memory of the copies while a scene loads.
constexpr uint64_t MAX_STAGING_BYTES = uint64_t(64) << 20;

} // namespace

ItemPool::ItemPool(RenderingDevice &p_device, const char *p_what, Format p_format) :
		device(p_device), what(p_what), format(p_format) {
	GNOMON_ASSERT(get_texel_size_bytes(format) == ITEM_BYTES, "format of ", what);
}

void ItemPool::grow(uint32_t p_count) {
	const uint64_t size = ranges.get_size_bytes();
	const uint64_t max_size = device.get_features().max_storage_buffer_bytes / ITEM_BYTES;
	if (size + p_count > max_size) {
		fail_capacity("edge_count needs ", (size + p_count) * ITEM_BYTES, " bytes for the ", what,
				" of all meshes that cast shadows, and ", device.get_info().name, " has room for ",
				max_size * ITEM_BYTES,
				" in one buffer. Let fewer meshes cast shadows, or set another shadow_technique.");
	}
	const uint64_t spare = buffer ? size / GROWTH_DIVISOR : 0;
	ranges.grow(std::min(std::max(size + p_count, size + spare), max_size));
}

ItemPool::Range ItemPool::allocate(uint32_t p_count) {
	if (p_count == 0) {
		return {};
	}
	std::optional<uint64_t> first = ranges.allocate(p_count, 1);
	if (!first) {
		grow(p_count);
		first = ranges.allocate(p_count, 1);
	}
	return { shared_from_this(), static_cast<uint32_t>(*first), p_count };
}

ItemPool::Range ItemPool::add(std::span<const uint8_t> p_bytes) {
	GNOMON_ASSERT(p_bytes.size() % ITEM_BYTES == 0, p_bytes.size(), " bytes of ", what);
	Range range = allocate(static_cast<uint32_t>(p_bytes.size() / ITEM_BYTES));
	if (range.get_count() > 0) {
		pending.push_back({ range.get_first(), { p_bytes.begin(), p_bytes.end() } });
	}
	return range;
}

void ItemPool::free(uint32_t p_first, uint32_t p_count) {
	ranges.free(p_first, p_count);
	std::erase_if(pending, [&](const Pending &p_added) { return p_added.first == p_first; });
	if (ranges.is_empty()) {
		ranges = RangeAllocator();
		buffer = {};
		capacity = 0;
	}
}

void ItemPool::submit(std::span<const Pending> p_pending, uint64_t p_size_bytes) {
	const OwnedBuffer staging(device,
			device.create_buffer({ .name = text("upload of ", what),
					.size_bytes = p_size_bytes,
					.usage = BufferUsage::COPY_SOURCE,
					.memory = MemoryKind::UPLOAD }));
	// All bytes first: Godot's device takes them when commands begin.
	uint8_t *mapped = device.get_mapped(staging.get());
	for (const Pending &added : p_pending) {
		std::memcpy(mapped, added.bytes.data(), added.bytes.size());
		mapped += added.bytes.size();
	}
	CommandList &commands = device.begin_commands();
	uint64_t offset_bytes = 0;
	for (const Pending &added : p_pending) {
		commands.copy_buffer(staging.get(), buffer.get(), added.bytes.size(), offset_bytes,
				uint64_t(added.first) * ITEM_BYTES);
		offset_bytes += added.bytes.size();
	}
	device.submit_commands(RenderingDevice::SubmitMode::QUEUE);
}

void ItemPool::upload() {
	const uint64_t size = ranges.get_size_bytes();
	if (size > capacity) {
		BufferDesc desc = make_fetched_buffer_desc(
				device, text(what, " of all meshes"), size * ITEM_BYTES, format);
		desc.usage = desc.usage | BufferUsage::COPY_SOURCE | BufferUsage::COPY_TARGET;
		OwnedBuffer grown(device, device.create_buffer(desc));
		if (buffer) {
			CommandList &commands = device.begin_commands();
			commands.copy_buffer(buffer.get(), grown.get(), capacity * ITEM_BYTES);
			device.submit_commands(RenderingDevice::SubmitMode::QUEUE);
		}
		buffer = std::move(grown);
		capacity = size;
	}
	size_t first = 0;
	uint64_t size_bytes = 0;
	for (size_t index = 0; index < pending.size(); ++index) {
		size_bytes += pending[index].bytes.size();
		if (size_bytes >= MAX_STAGING_BYTES || index + 1 == pending.size()) {
			submit(std::span(pending).subspan(first, index + 1 - first), size_bytes);
			first = index + 1;
			size_bytes = 0;
		}
	}
	pending.clear();
}

} // namespace gnomon
