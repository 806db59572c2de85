#include "modules/rendering_device/tests/device_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

constexpr uint64_t MIB = 1 << 20;
constexpr uint64_t BLOCK_BYTES = 64 * MIB; // MemoryAllocator::BLOCK_BYTES

BufferDesc make_desc(const std::string &p_name, uint64_t p_size_bytes) {
	return { .name = p_name,
		.size_bytes = p_size_bytes,
		.usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE | BufferUsage::COPY_TARGET };
}

} // namespace

TEST_CASE("[GPU][RenderingDevice] an error about the budget names the three largest resources") {
	DeviceFixture fixture({ .memory_budget_bytes = 100 * MIB });
	RenderingDevice &device = *fixture.device;
	std::vector<OwnedBuffer> buffers;
	for (uint64_t size_mib : { 1, 40, 20, 30 }) {
		buffers.emplace_back(
				device, device.create_buffer(make_desc(text("part ", size_mib), size_mib * MIB)));
	}
	CHECK(device.get_memory_use().budget_bytes == 100 * MIB);
	const std::string error = catch_error([&] {
		device.create_texture(
				{ .name = "too large", .size_px = glm::uvec2(2048) }); // 16 MiB, 9 are left
	});
	CAPTURE(error);
	CHECK(contains(error, "texture 'too large' needs 16 MiB"));
	CHECK(contains(error, "of 100 MiB"));
	CHECK(contains(error, "buffer 'part 40' 40 MiB, buffer 'part 30' 30 MiB, buffer 'part 20' 20"));
	CHECK_FALSE(contains(error, "'part 1'"));
	CHECK(contains(error, "--device"));
	buffers.pop_back();
	const OwnedTexture texture(
			device, device.create_texture({ .name = "fits", .size_px = glm::uvec2(2048) }));
	CHECK(device.get_memory_use().peak_bytes >= 91 * MIB);
	CHECK(list_live_resources(device) ==
			std::vector<std::string>{
					"buffer 'part 1'", "buffer 'part 20'", "buffer 'part 40'", "texture 'fits'" });
}

TEST_CASE("[GPU][RenderingDevice] unsupported sizes and formats are errors that name the reason") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const uint32_t max_size_px = device.get_features().max_texture_size_px;
	const std::string texture_error = catch_error([&] {
		device.create_texture({ .name = "wide", .size_px = { max_size_px + 1, 1 } });
	});
	CHECK(contains(texture_error, "'wide'"));
	CHECK(contains(texture_error, text(max_size_px)));
	const uint64_t max_bytes = device.get_features().max_storage_buffer_bytes;
	const std::string buffer_error =
			catch_error([&] { device.create_buffer(make_desc("long", max_bytes + 4)); });
	CHECK(contains(buffer_error, "'long'"));
	CHECK(contains(buffer_error, text(max_bytes)));
	const std::string format_error = catch_error([&] {
		device.create_texture({ .name = "depth",
				.format = Format::D32_SFLOAT,
				.usage = TextureUsage::COLOR_ATTACHMENT });
	});
	CHECK(contains(format_error, "D32_SFLOAT"));
	CHECK(contains(format_error, "COLOR_ATTACHMENT"));
	CHECK(list_live_resources(device).empty());
}

TEST_CASE("[GPU][RenderingDevice] memory of a freed resource is reused after its submission") {
	DeviceFixture fixture({ .memory_budget_bytes = 64 * MIB }); // for one buffer of 40 MiB
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer readback = fixture.make_readback(4);
	const OwnedBuffer numbers = fixture.make_buffer(
			"numbers", std::vector<uint32_t>{ 0, 1, 2, 3, 4, 5 }, BufferUsage::COPY_SOURCE);
	for (uint32_t frame = 0; frame < 6; ++frame) {
		CommandList &commands = device.begin_commands();
		const OwnedBuffer buffer(device, device.create_buffer(make_desc("large", 40 * MIB)));
		commands.copy_buffer(numbers.get(), buffer.get(), /*p_size_bytes=*/4,
				/*p_source_offset_bytes=*/4 * frame, /*p_target_offset_bytes=*/20 * MIB);
		const Barrier barrier = {
			.buffer = buffer.get(), .before = Access::COPY_WRITE, .after = Access::COPY_READ
		};
		commands.barriers({ &barrier, 1 });
		commands.copy_buffer(buffer.get(), readback.get(), 4, 20 * MIB);
		device.submit_commands(SubmitMode::QUEUE);
		// Freed while the GPU uses it; the next frame's buffer waits for this one's end.
	}
	device.wait_idle();
	CHECK(fixture.read<uint32_t>(readback, 1)[0] == 5);
	CHECK(device.get_memory_use().used_bytes < MIB);
	CHECK(device.get_memory_use().peak_bytes < 64 * MIB); // the budget
}

TEST_CASE("[GPU][RenderingDevice] blocks of memory return to the driver") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const uint64_t allocated_before = device.get_memory_use().allocated_bytes;
	{
		std::vector<OwnedBuffer> buffers;
		for (int index = 0; index < 12; ++index) {
			buffers.emplace_back(device, device.create_buffer(make_desc("part", 20 * MIB)));
		}
		const OwnedBuffer large(device, device.create_buffer(make_desc("large", 100 * MIB)));
		// 12 x 20 + 100 MiB, of which some may fit into one block that existed before.
		CHECK(device.get_memory_use().allocated_bytes >=
				allocated_before + 340 * MIB - BLOCK_BYTES);
	}
	CHECK(device.get_memory_use().allocated_bytes <= allocated_before + BLOCK_BYTES); // one spare
}

TEST_CASE("[GPU][RenderingDevice] resources alive when the device is destroyed are reported by "
		  "name") {
	CaughtLog log;
	{
		DeviceFixture fixture;
		fixture.device->create_texture({ .name = "albedo" });
		fixture.device->create_sampler({ .name = "nearest" });
		fixture.device->create_buffer(make_desc("lights", 16));
		const OwnedBuffer freed(
				*fixture.device, fixture.device->create_buffer(make_desc("ok", 16)));
	}
	CHECK(log.count("Leaked") == 3);
	CHECK(log.count("Leaked texture 'albedo'") == 1);
	CHECK(log.count("Leaked sampler 'nearest'") == 1);
	CHECK(log.count("Leaked buffer 'lights'") == 1);
}

TEST_CASE("[GPU][RenderingDevice] textures placed in the same memory can be used in turn") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const TextureDesc color_desc = { .name = "color",
		.format = Format::RGBA16_SFLOAT,
		.size_px = glm::uvec2(64),
		.usage = TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE };
	const TextureDesc result_desc = { .name = "result",
		.format = Format::R32_UINT,
		.size_px = glm::uvec2(64),
		.usage = TextureUsage::COPY_TARGET | TextureUsage::COPY_SOURCE };
	const auto needs = device.get_placement_requirements(color_desc);
	CHECK(needs.size_bytes >= 64 * 64 * 8);
	const OwnedMemory memory(device, device.create_texture_memory("shared", needs.size_bytes));
	const OwnedTexture color(
			device, device.create_placed_texture(color_desc, memory.get(), /*p_offset_bytes=*/0));
	const OwnedTexture result(
			device, device.create_placed_texture(result_desc, memory.get(), /*p_offset_bytes=*/0));
	const OwnedBuffer readback = fixture.make_readback(64 * 64 * 8);
	CommandList &commands = device.begin_commands();
	const auto change = [&](const Barrier &p_barrier) { commands.barriers({ &p_barrier, 1 }); };
	change({ .texture = color.get(), .after = Access::COLOR_WRITE });
	const ColorTarget target = { .texture = color.get(), .clear = glm::vec4(1) };
	commands.begin_rendering({ &target, 1 }, nullptr);
	commands.end_rendering();
	change({ .texture = color.get(), .before = Access::COLOR_WRITE, .after = Access::COPY_READ });
	commands.copy_texture_to_buffer(color.get(), readback.get());
	change({ .texture = result.get(),
			.after = Access::COPY_WRITE,
			.earlier_users = { Access::COLOR_WRITE, Access::COPY_READ } });
	commands.clear_color(result.get(), glm::vec4(42));
	device.submit_commands(SubmitMode::WAIT);
	CHECK(fixture.read<uint16_t>(readback, 1)[0] == 0x3c00); // 1.0 as a half
	CHECK(fixture.read_texture<uint32_t>(result.get(), Access::COPY_WRITE) ==
			std::vector<uint32_t>(64 * 64, 42));
	CHECK(list_live_resources(device).size() == 4); // memory, color, result, readback
}

TEST_CASE("[GPU][RenderingDevice] abandoned commands leave the device usable") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer readback = fixture.make_readback(4);
	const OwnedBuffer numbers = fixture.make_buffer(
			"numbers", std::vector<uint32_t>{ 99, 1, 2, 3 }, BufferUsage::COPY_SOURCE);
	for (uint32_t round = 1; round < 4; ++round) {
		CommandList &abandoned = device.begin_commands();
		abandoned.begin_span("never finished");
		abandoned.copy_buffer(numbers.get(), readback.get(), 4);
		device.abandon_commands();
		CommandList &commands = device.begin_commands();
		commands.begin_span("fill");
		commands.copy_buffer(numbers.get(), readback.get(), 4, 4 * round);
		commands.end_span();
		device.submit_commands(SubmitMode::WAIT);
		CHECK(fixture.read<uint32_t>(readback, 1)[0] == round);
		CHECK(device.get_gpu_spans().size() == 1);
	}
	device.abandon_commands(); // does nothing, because no commands are being recorded
}
