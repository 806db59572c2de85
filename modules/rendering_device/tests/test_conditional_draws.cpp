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
	for (const uint32_t predicate : { 0u, 1u }) {
		const TriangleTargets targets(fixture);
		const OwnedBuffer condition =
				fixture.make_buffer("condition", std::vector<uint32_t>{ predicate, 7u },
						BufferUsage::CONDITIONAL | BufferUsage::COPY_TARGET);
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
