#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace gnomon {

/// Hands out ranges of one block of bytes: from the smallest gap that fits, the lowest of equal
/// ones; neighbours are joined when they come back. Knows nothing of what the bytes are. Time grows
/// with the logarithm of the number of gaps.
class RangeAllocator {
public:
	explicit RangeAllocator(uint64_t p_size_bytes);

	/// The offset of p_size_bytes (above 0) at a multiple of p_alignment_bytes (a power of two), or
	/// nothing when no gap is large enough.
	std::optional<uint64_t> allocate(uint64_t p_size_bytes, uint64_t p_alignment_bytes);
	/// Gives back exactly what allocate() handed out; anything else is an assertion.
	void free(uint64_t p_offset_bytes, uint64_t p_size_bytes);

	bool is_empty() const { return free_bytes == size_bytes; }
	uint64_t get_free_bytes() const { return free_bytes; }
	/// How many gaps there are; 1 when all neighbours have been joined and nothing is in use.
	size_t get_gap_count() const { return gaps.size(); }

private:
	using Gaps = std::map<uint64_t, uint64_t>;

	void add_gap(uint64_t p_offset_bytes, uint64_t p_size_bytes);
	void remove_gap(Gaps::iterator p_gap);

	uint64_t size_bytes;
	uint64_t free_bytes;
	Gaps gaps;										 // offset -> size
	std::set<std::pair<uint64_t, uint64_t>> by_size; // the same: size, offset
};

} // namespace gnomon
