#include "modules/rendering_device/range_allocator.h"

#include "modules/core/error.h"

namespace gnomon {

RangeAllocator::RangeAllocator(uint64_t p_size_bytes) :
		size_bytes(p_size_bytes), free_bytes(p_size_bytes) {
	if (p_size_bytes > 0) {
		add_gap(0, p_size_bytes);
	}
}

void RangeAllocator::add_gap(uint64_t p_offset_bytes, uint64_t p_size_bytes) {
	gaps[p_offset_bytes] = p_size_bytes;
	by_size.insert({ p_size_bytes, p_offset_bytes });
}

void RangeAllocator::remove_gap(Gaps::iterator p_gap) {
	by_size.erase({ p_gap->second, p_gap->first });
	gaps.erase(p_gap);
}

std::optional<uint64_t> RangeAllocator::allocate(
		uint64_t p_size_bytes, uint64_t p_alignment_bytes) {
	GNOMON_ASSERT(p_size_bytes > 0, "size ", p_size_bytes);
	GNOMON_ASSERT(
			(p_alignment_bytes & (p_alignment_bytes - 1)) == 0, "alignment ", p_alignment_bytes);
	for (auto gap = by_size.lower_bound({ p_size_bytes, 0 }); gap != by_size.end(); ++gap) {
		const auto [size, begin] = *gap;
		const uint64_t offset = (begin + p_alignment_bytes - 1) & ~(p_alignment_bytes - 1);
		const uint64_t padding = offset - begin;
		if (padding > size || size - padding < p_size_bytes) {
			continue;
		}
		// The bytes that alignment skips stay a gap, for smaller requests.
		const uint64_t rest = size - padding - p_size_bytes;
		remove_gap(gaps.find(begin));
		if (padding > 0) {
			add_gap(begin, padding);
		}
		if (rest > 0) {
			add_gap(offset + p_size_bytes, rest);
		}
		free_bytes -= p_size_bytes;
		return offset;
	}
	return std::nullopt;
}

void RangeAllocator::free(uint64_t p_offset_bytes, uint64_t p_size_bytes) {
	GNOMON_ASSERT(p_offset_bytes + p_size_bytes <= size_bytes, "range ", p_offset_bytes, " + ",
			p_size_bytes, " of ", size_bytes);
	uint64_t begin = p_offset_bytes;
	uint64_t end = p_offset_bytes + p_size_bytes;
	auto next = gaps.lower_bound(begin);
	GNOMON_ASSERT(next == gaps.end() || next->first >= end, "range ", begin, "..", end,
			" was free already, from ", next->first);
	if (next != gaps.begin()) {
		const auto before = std::prev(next);
		const uint64_t before_end = before->first + before->second;
		GNOMON_ASSERT(before_end <= begin, "range ", begin, "..", end, " was free already, up to ",
				before_end);
		if (before_end == begin) {
			begin = before->first;
			remove_gap(before);
		}
	}
	if (next != gaps.end() && next->first == end) {
		end += next->second;
		remove_gap(next);
	}
	add_gap(begin, end - begin);
	free_bytes += p_size_bytes;
}

void RangeAllocator::grow(uint64_t p_size_bytes) {
	GNOMON_ASSERT(p_size_bytes >= size_bytes, "size ", p_size_bytes, ", was ", size_bytes);
	const uint64_t old_size_bytes = std::exchange(size_bytes, p_size_bytes);
	if (p_size_bytes > old_size_bytes) {
		free(old_size_bytes, p_size_bytes - old_size_bytes);
	}
}

} // namespace gnomon
