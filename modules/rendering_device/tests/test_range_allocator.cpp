#include "modules/rendering_device/range_allocator.h"

#include <doctest/doctest.h>

#include <random>

using namespace gnomon;

TEST_CASE("[RangeAllocator] random allocations do not overlap and can all be freed") {
	constexpr uint64_t SIZE = 1 << 16;
	struct Range {
		uint64_t begin, size;
	};
	std::mt19937 random(1);
	RangeAllocator allocator(SIZE);
	std::vector<Range> ranges;
	std::vector<bool> is_taken(SIZE);
	uint64_t taken_bytes = 0;
	bool is_correct = true;
	for (int step = 0; step < 20000; ++step) {
		if (ranges.empty() || random() % 5 < 3) { // allocates more often than it frees: fills up
			const uint64_t size = 1 + random() % 3000;
			const uint64_t alignment = uint64_t(1) << random() % 10;
			const auto begin = allocator.allocate(size, alignment);
			if (!begin) {
				continue;
			}
			is_correct = is_correct && *begin % alignment == 0 && *begin + size <= SIZE;
			for (uint64_t byte = *begin; byte < *begin + size; ++byte) {
				is_correct = is_correct && !is_taken[byte];
				is_taken[byte] = true;
			}
			ranges.push_back({ *begin, size });
			taken_bytes += size;
		} else {
			std::swap(ranges[random() % ranges.size()], ranges.back());
			const Range range = ranges.back();
			ranges.pop_back();
			allocator.free(range.begin, range.size);
			std::fill_n(is_taken.begin() + static_cast<ptrdiff_t>(range.begin), range.size, false);
			taken_bytes -= range.size;
		}
		is_correct = is_correct && allocator.get_free_bytes() == SIZE - taken_bytes;
	}
	CHECK(is_correct);
	for (const Range &range : ranges) {
		allocator.free(range.begin, range.size);
	}
	CHECK(allocator.is_empty());
	CHECK(allocator.get_gap_count() == 1);
	CHECK(allocator.allocate(SIZE, 1) == 0);
}

TEST_CASE("[RangeAllocator] a request that does not fit is refused") {
	RangeAllocator allocator(100);
	CHECK_FALSE(allocator.allocate(101, 1));
	CHECK(allocator.allocate(1, 1) == 0);
	CHECK_FALSE(allocator.allocate(99, 2)); // the gap begins at 1, aligned it is one byte short
	CHECK(allocator.allocate(98, 2) == 2);
	CHECK(allocator.allocate(1, 1) == 1); // what alignment skipped
	CHECK_FALSE(allocator.allocate(1, 1));
}

TEST_CASE("[RangeAllocator] a block that grows keeps its ranges, and its last gap grows with it") {
	RangeAllocator allocator;
	CHECK_FALSE(allocator.allocate(1, 1));
	allocator.grow(10);
	CHECK(allocator.allocate(6, 1) == 0);
	CHECK_FALSE(allocator.allocate(5, 1));
	allocator.grow(11);
	CHECK(allocator.get_gap_count() == 1);
	CHECK(allocator.allocate(5, 1) == 6);
	allocator.grow(20);
	allocator.free(0, 6);
	CHECK(allocator.allocate(9, 1) == 11);
	CHECK(allocator.get_free_bytes() == 6);
	allocator.free(6, 5);
	allocator.free(11, 9);
	CHECK(allocator.is_empty());
	CHECK(allocator.get_size_bytes() == 20);
}
