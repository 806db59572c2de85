#include "modules/render_graph/transient_pool.h"

#include <doctest/doctest.h>

#include <random>

using namespace gnomon;

namespace {

bool overlaps(const PlacedBlock &p_left, const PlacedBlock &p_right) {
	const bool in_time =
			p_left.first_pass <= p_right.last_pass && p_right.first_pass <= p_left.last_pass;
	const bool in_memory = p_left.offset_bytes < p_right.offset_bytes + p_right.size_bytes &&
			p_right.offset_bytes < p_left.offset_bytes + p_left.size_bytes;
	return in_time && in_memory;
}

} // namespace

TEST_CASE("[TransientPool] blocks that live one after the other share their memory") {
	// Size, alignment, first and last pass.
	std::vector<PlacedBlock> blocks = { { 100, 1, 0, 1 }, { 100, 1, 2, 3 }, { 60, 1, 4, 4 } };
	CHECK(place_blocks(blocks) == 100);
	CHECK(blocks[0].offset_bytes == blocks[1].offset_bytes);
}

TEST_CASE("[TransientPool] blocks that live at the same time do not overlap and are aligned") {
	std::vector<PlacedBlock> blocks = { { 100, 64, 0, 2 }, { 100, 64, 2, 3 } };
	CHECK(place_blocks(blocks) == 228); // 128, the first multiple of 64 above 100, plus 100
	CHECK(blocks[1].offset_bytes % 64 == 0);
}

TEST_CASE("[TransientPool] in 200 random sets, no blocks overlap in time and memory") {
	std::mt19937 random(7);
	const auto draw = [&](uint32_t p_limit) { return static_cast<uint32_t>(random() % p_limit); };
	for (int set = 0; set < 200; ++set) {
		std::vector<PlacedBlock> blocks(1 + draw(20));
		uint64_t sum_bytes = 0;
		for (PlacedBlock &block : blocks) {
			block.size_bytes = 1 + draw(1000);
			block.alignment_bytes = uint64_t(1) << draw(9);
			block.first_pass = draw(30);
			block.last_pass = block.first_pass + draw(10);
			sum_bytes += block.size_bytes + block.alignment_bytes;
		}
		CHECK(place_blocks(blocks) <= sum_bytes);
		for (size_t left = 0; left < blocks.size(); ++left) {
			CHECK(blocks[left].offset_bytes % blocks[left].alignment_bytes == 0);
			for (size_t right = left + 1; right < blocks.size(); ++right) {
				CHECK_FALSE(overlaps(blocks[left], blocks[right]));
			}
		}
	}
}

TEST_CASE("[TransientPool] equal buffers that live one after the other are shared, no others") {
	const auto request = [](uint32_t p_first, uint32_t p_last, const BufferDesc &p_desc) {
		TransientRequest made;
		made.is_texture = false;
		made.buffer = p_desc;
		made.first_pass = p_first;
		made.last_pass = p_last;
		return made;
	};
	const BufferDesc small = { "small", 64 };
	const BufferDesc alike = { "another name", 64 };
	const BufferDesc large = { "large", 128 };
	const BufferDesc mapped = { "mapped", 64, BufferUsage::STORAGE, MemoryKind::READBACK };
	// In the order of creation, which differs from the order of use.
	const std::vector<TransientRequest> requests = { request(4, 5, small), request(0, 2, alike),
		request(2, 3, small), request(3, 6, small), request(6, 7, large), request(0, 1, mapped),
		request(2, 3, mapped), TransientRequest() };
	std::vector<std::vector<uint32_t>> predecessors(requests.size());
	const std::vector<uint32_t> owners =
			share_resources(requests, SharedKinds::BUFFERS, predecessors);
	CHECK(owners[1] == 1);
	CHECK(owners[2] == 2); // begins in the pass in which the first one ends
	CHECK(owners[3] == 1);
	CHECK(owners[0] == 2);
	CHECK(predecessors[3] == std::vector<uint32_t>{ 1 });
	CHECK(predecessors[0] == std::vector<uint32_t>{ 2 });
	CHECK(predecessors[1].empty());
	CHECK(owners[4] == 4);
	CHECK(owners[5] == 5);
	CHECK(owners[6] == 6);
}

TEST_CASE("[TransientPool] without aliased memory, equal textures are shared, others are not") {
	const auto request = [](uint32_t p_first, uint32_t p_last, const TextureDesc &p_desc) {
		TransientRequest made;
		made.texture = p_desc;
		made.first_pass = p_first;
		made.last_pass = p_last;
		return made;
	};
	const TextureDesc small = { .name = "small", .size_px = glm::uvec2(8) };
	const TextureDesc alike = { .name = "another name", .size_px = glm::uvec2(8) };
	const TextureDesc array = { .name = "array", .size_px = glm::uvec2(8), .is_array = true };
	const std::vector<TransientRequest> requests = { request(0, 1, small), request(1, 2, alike),
		request(2, 3, alike), request(3, 4, array) };
	std::vector<std::vector<uint32_t>> predecessors(requests.size());
	CHECK(share_resources(requests, SharedKinds::BUFFERS, predecessors) ==
			std::vector<uint32_t>{ 0, 1, 2, 3 });
	CHECK(share_resources(requests, SharedKinds::BUFFERS_AND_TEXTURES, predecessors) ==
			std::vector<uint32_t>{ 0, 1, 0, 3 });
	CHECK(predecessors[2] == std::vector<uint32_t>{ 0 });
}
