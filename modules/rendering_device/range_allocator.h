#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace gnomon {

/// Best-fit allocator for ranges of one block of bytes, or of other units; among equally small gaps
/// it takes the lowest. Freed neighbours are merged. It never accesses the bytes. Time is
/// logarithmic in the number of gaps, unless alignment makes gaps of sufficient size too small.
class RangeAllocator {
public:
	explicit RangeAllocator(uint64_t p_size_bytes = 0);

	/// Returns the offset of p_size_bytes (above 0) at a multiple of p_alignment_bytes (a power of
	/// two), or nothing if no gap is large enough.
	std::optional<uint64_t> allocate(uint64_t p_size_bytes, uint64_t p_alignment_bytes);
	/// Frees exactly a range that allocate() returned. Freeing bytes twice is an assertion.
	void free(uint64_t p_offset_bytes, uint64_t p_size_bytes);

	/// Appends free bytes. p_size_bytes: the new size, at least the present one.
	void grow(uint64_t p_size_bytes);

	bool is_empty() const { return free_bytes == size_bytes; }
	uint64_t get_size_bytes() const { return size_bytes; }
	uint64_t get_free_bytes() const { return free_bytes; }
	/// Returns the number of gaps; 1 if nothing is in use.
	size_t get_gap_count() const { return gaps.size(); }

private:
	using Gaps = std::map<uint64_t, uint64_t>;

	void add_gap(uint64_t p_offset_bytes, uint64_t p_size_bytes);
	void remove_gap(Gaps::iterator p_gap);

	uint64_t size_bytes;
	uint64_t free_bytes;
	Gaps gaps;										 // offset -> size
	std::set<std::pair<uint64_t, uint64_t>> by_size; // the same gaps as (size, offset)
};

} // namespace gnomon
