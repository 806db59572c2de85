// The buffers that all meshes share: ranges keep their content while others come and go.

#include "modules/rendering_device/command_list.h"
#include "modules/shadow_edge_count/item_pool.h"

#include "tests/shaders/kernel_fixture.h"

#include <doctest/doctest.h>

#include <map>
#include <string>

using namespace gnomon;

namespace {

/// Items that contain p_value.
std::vector<glm::uvec4> make_items(uint32_t p_value, uint32_t p_count) {
	return std::vector<glm::uvec4>(p_count, glm::uvec4(p_value, p_value + 1, p_value + 2, 7));
}

ItemPool::Range add(ItemPool &r_pool, uint32_t p_value, uint32_t p_count) {
	const std::vector<glm::uvec4> items = make_items(p_value, p_count);
	return r_pool.add(
			{ reinterpret_cast<const uint8_t *>(items.data()), p_count * sizeof(items[0]) });
}

/// The pool's content after upload().
std::vector<glm::uvec4> read(KernelFixture &r_fixture, ItemPool &r_pool) {
	r_pool.upload();
	const uint64_t size_bytes = r_fixture.device->get_desc(r_pool.get_buffer().get()).size_bytes;
	const OwnedBuffer readback = r_fixture.make_readback(size_bytes);
	CommandList &commands = r_fixture.device->begin_commands();
	commands.copy_buffer(r_pool.get_buffer().get(), readback.get(), size_bytes);
	r_fixture.device->submit_commands(RenderingDevice::SubmitMode::WAIT);
	return r_fixture.read<glm::uvec4>(readback, size_bytes / sizeof(glm::uvec4));
}

} // namespace

TEST_CASE("[GPU][EdgeCount] ranges of the meshes' buffers keep their content while others change") {
	KernelFixture fixture;
	const auto pool = std::make_shared<ItemPool>(*fixture.device, "items", Format::RGBA32_UINT);
	std::map<uint32_t, ItemPool::Range> ranges; // by value
	for (uint32_t step = 0; step < 40; ++step) {
		ranges[step] = add(*pool, step, 1 + step * step % 37);
		if (step % 3 == 2) {
			ranges.erase(step / 2); // some are freed before they were uploaded
		}
		if (step % 5 != 4) {
			continue;
		}
		const std::vector<glm::uvec4> content = read(fixture, *pool);
		for (const auto &[value, range] : ranges) {
			CAPTURE(value);
			REQUIRE(range.get_first() + range.get_count() <= content.size());
			const std::vector<glm::uvec4> found(content.begin() + range.get_first(),
					content.begin() + range.get_first() + range.get_count());
			CHECK(found == make_items(value, range.get_count()));
		}
	}
	ranges.clear();
	CHECK_FALSE(pool->get_buffer()); // nothing is left, so its memory is freed
	const ItemPool::Range again = add(*pool, 3, 5);
	CHECK(read(fixture, *pool) == make_items(3, 5));
}

TEST_CASE("[GPU][EdgeCount] an empty range has no items, and too many are refused with the limit") {
	KernelFixture fixture;
	const auto pool = std::make_shared<ItemPool>(*fixture.device, "faces", Format::RGBA32_UINT);
	CHECK(pool->allocate(0).get_count() == 0);
	pool->upload();
	CHECK_FALSE(pool->get_buffer());
	const uint64_t max_items =
			fixture.device->get_features().max_storage_buffer_bytes / ItemPool::ITEM_BYTES;
	REQUIRE(max_items < ~0u);
	std::string message;
	try {
		pool->allocate(uint32_t(max_items) + 1);
	} catch (const std::exception &error) {
		message = error.what();
	}
	CHECK(message.find("bytes for the faces of all meshes") != std::string::npos);
	CHECK(message.find(std::to_string(max_items * ItemPool::ITEM_BYTES)) != std::string::npos);
	CHECK(pool->allocate(1).get_count() == 1); // it is still usable
}
