#pragma once

#include "modules/rendering_device/range_allocator.h"
#include "modules/rendering_device/rendering_device.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// One buffer of items in GPU memory, of which each mesh has a range, so that one dispatch can read
/// the items of any number of meshes. It grows when ranges are added. An item has 16 bytes.
class ItemPool : public std::enable_shared_from_this<ItemPool> {
public:
	static constexpr uint32_t ITEM_BYTES = 16;

	/// A range of items, freed with its owner. Empty ranges are possible.
	class Range {
	public:
		Range() = default;
		Range(std::shared_ptr<ItemPool> p_pool, uint32_t p_first, uint32_t p_count) :
				pool(std::move(p_pool)), first(p_first), count(p_count) {}
		Range(Range &&) = default;
		Range &operator=(Range &&p_other) noexcept {
			std::swap(pool, p_other.pool);
			std::swap(first, p_other.first);
			std::swap(count, p_other.count);
			return *this;
		}
		~Range() {
			if (pool) {
				pool->free(first, count);
			}
		}
		uint32_t get_first() const { return first; }
		uint32_t get_count() const { return count; }

	private:
		std::shared_ptr<ItemPool> pool;
		uint32_t first = 0;
		uint32_t count = 0;
	};

	/// p_what: the items, for messages: "faces". The pool must be owned by a shared_ptr.
	ItemPool(RenderingDevice &p_device, const char *p_what, Format p_format);

	/// Reserves items without content. Throws an Error if the device has no buffer of that size.
	Range allocate(uint32_t p_count);
	/// Reserves items with this content, which upload() copies into the buffer.
	Range add(std::span<const uint8_t> p_bytes);
	/// Submits the copies of what was added since the last call. Not while commands are being
	/// recorded.
	void upload();
	/// The buffer after upload(); of storage and, where the device can, of texels. Another one when
	/// the pool has grown, so passes that are not yet recorded must own it.
	const SharedBuffer &get_buffer() const { return buffer; }

private:
	/// Content that is not in the buffer yet.
	struct Pending {
		uint32_t first = 0;
		std::vector<uint8_t> bytes;
	};

	void free(uint32_t p_first, uint32_t p_count);
	void grow(uint32_t p_count);
	void submit(std::span<const Pending> p_pending, uint64_t p_size_bytes);

	RenderingDevice &device;
	const char *what;
	Format format;
	RangeAllocator ranges; // in items
	std::vector<Pending> pending;
	SharedBuffer buffer;
	uint64_t capacity = 0; // of the buffer, in items
};

} // namespace gnomon
