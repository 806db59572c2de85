#include "modules/rendering_device/tests/triangle_fixture.h"

#include <doctest/doctest.h>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

TEST_CASE("[GPU][RenderingDevice] conditional draws happen only while the predicate is not 0") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	if (!device.get_features().conditional_rendering) {
		MESSAGE("this device has no conditional rendering");
		return;
	}
	const PipelineRID pipeline = device.get_raster_pipeline(make_triangle_desc());
	const OwnedBuffer vertices = fixture.make_buffer("vertices", TRIANGLE, BufferUsage::VERTEX);
	constexpr uint32_t UNREAD_WORD = 7; // not 0: would enable the draw
	for (const uint32_t predicate : { 0u, 1u }) {
		const TriangleTargets targets(fixture);
		const OwnedBuffer condition = fixture.make_buffer("condition",
				std::vector<uint32_t>{ predicate, UNREAD_WORD }, BufferUsage::CONDITIONAL);
		CommandList &commands = device.begin_commands();
		commands.barriers(targets.get_barriers());
		const ColorTarget color = { targets.color.get() };
		const DepthTarget depth = { targets.depth.get() };
		commands.begin_rendering({ &color, 1 }, &depth);
		commands.begin_conditional(condition.get());
		draw_triangle(commands, pipeline, vertices.get());
		commands.end_conditional();
		commands.end_rendering();
		device.submit_commands(SubmitMode::WAIT);
		const auto texels =
				fixture.read_texture<uint32_t>(targets.color.get(), Access::COLOR_WRITE);
		CHECK((texels[0] != 0) == (predicate != 0));
	}
}

TEST_CASE("[GPU][RenderingDevice] conditional dispatches read the word at their offset") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	if (!device.get_features().conditional_rendering) {
		MESSAGE("this device has no conditional rendering");
		return;
	}
	// modules/rendering_device/tests/scale.comp with local size 1, factor 2, and the push constants
	// count 1 and offset 10: the target gets 5 * 2 + 10 = 20 instead of its initial 1.
	const PipelineRID pipeline =
			device.get_compute_pipeline({ "scale", "tests/scale.comp", { { 0, 1 }, { 1, 2 } } });
	const OwnedBuffer source =
			fixture.make_buffer("source", std::vector<uint32_t>{ 5 }, BufferUsage::STORAGE);
	const OwnedBuffer condition = fixture.make_buffer(
			"condition", std::vector<uint32_t>{ 0, 3 }, BufferUsage::CONDITIONAL);
	for (uint32_t word = 0; word < 2; ++word) {
		const OwnedBuffer target = fixture.make_buffer("target", std::vector<uint32_t>{ 1 },
				BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
		const OwnedBuffer readback = fixture.make_readback(sizeof(uint32_t));
		CommandList &commands = device.begin_commands();
		commands.begin_conditional(condition.get(), word * sizeof(uint32_t));
		commands.bind_pipeline(pipeline);
		commands.bind_resources({ { 0, source.get() }, { 1, target.get() } });
		commands.push_constants(glm::uvec2(1u, 10u));
		commands.dispatch({ 1, 1, 1 });
		commands.end_conditional();
		const Barrier barrier = { .buffer = target.get(),
			.before = Access::SHADER_WRITE_COMPUTE,
			.after = Access::COPY_READ };
		commands.barriers({ &barrier, 1 });
		commands.copy_buffer(target.get(), readback.get(), sizeof(uint32_t));
		device.submit_commands(SubmitMode::WAIT);
		CHECK(fixture.read<uint32_t>(readback, 1)[0] == (word == 0 ? 1u : 20u));
	}
}
