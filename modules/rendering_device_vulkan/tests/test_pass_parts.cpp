// Passes with many triangles are recorded in parts.

#include "modules/rendering_device/tests/triangle_fixture.h"
#include "modules/rendering_device_vulkan/vulkan_device.h"

#include <doctest/doctest.h>

#include <map>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

/// Covers the lower right half of the image, at depth 0.75.
const std::vector<float> OPPOSITE = { 1, 1, 0.75f, 1, -1, 0.75f, -1, 1, 0.75f };

struct Drawn {
	std::vector<uint32_t> colors;
	std::vector<float> depths;
	uint64_t continued_part_count = 0;
};

/// Draws the triangle in red, the opposite one in green, and again the first in blue, behind
/// itself.
Drawn draw_halves(uint64_t p_max_part_triangles, bool p_is_conditional) {
	DeviceFixture fixture;
	auto &device = static_cast<VulkanDevice &>(*fixture.device); // the only backend of this program
	const uint64_t previous = std::exchange(device.max_part_triangles, p_max_part_triangles);
	RasterPipelineDesc desc = make_triangle_desc();
	desc.depth_compare = CompareOp::LESS;
	const PipelineRID pipeline = device.get_raster_pipeline(desc);
	std::vector<float> behind = TRIANGLE;
	behind[2] = behind[5] = behind[8] = 0.5f;
	const OwnedBuffer halves[] = { fixture.make_buffer("first", TRIANGLE, BufferUsage::VERTEX),
		fixture.make_buffer("opposite", OPPOSITE, BufferUsage::VERTEX),
		fixture.make_buffer("behind", behind, BufferUsage::VERTEX) };
	const OwnedBuffer condition = p_is_conditional
			? fixture.make_buffer("condition", std::vector<uint32_t>{ 1 }, BufferUsage::CONDITIONAL)
			: OwnedBuffer();
	const TriangleTargets targets(fixture);
	const uint64_t before = device.continued_part_count;
	CommandList &commands = device.begin_commands();
	commands.barriers(targets.get_barriers());
	const ColorTarget color = { targets.color.get() };
	const DepthTarget depth = { targets.depth.get() };
	commands.begin_rendering({ &color, 1 }, &depth);
	commands.bind_pipeline(pipeline);
	commands.set_scissor({ 0, 0 }, { 8, 7 });
	if (p_is_conditional) {
		commands.begin_conditional(condition.get());
	}
	for (uint32_t index = 0; index < 3; ++index) {
		glm::vec4 value(0, 0, 0, 1);
		value[int(index)] = 1;
		commands.push_constants(value);
		const BufferRID vertices = halves[index].get();
		commands.bind_vertex_buffers({ &vertices, 1 });
		commands.draw(3);
	}
	if (p_is_conditional) {
		commands.end_conditional();
	}
	commands.end_rendering();
	device.submit_commands(SubmitMode::WAIT);
	Drawn drawn;
	drawn.continued_part_count = device.continued_part_count - before;
	drawn.colors = fixture.read_texture<uint32_t>(targets.color.get(), Access::COLOR_WRITE);
	drawn.depths = fixture.read_texture<float>(targets.depth.get(), Access::DEPTH_WRITE);
	device.max_part_triangles = previous;
	return drawn;
}

} // namespace

TEST_CASE("[GPU][RenderingDevice] a pass in parts draws the same image") {
	const Drawn whole = draw_halves(/*p_max_part_triangles=*/3, /*p_is_conditional=*/false);
	CHECK(whole.continued_part_count == 0);
	const uint32_t RED = 0xff0000ff;
	const uint32_t GREEN = 0xff00ff00;
	std::map<uint32_t, uint32_t> pixel_counts;
	for (const uint32_t value : whole.colors) {
		++pixel_counts[value];
	}
	CHECK(pixel_counts.size() == 3); // the last row is outside the scissor rectangle
	CHECK(pixel_counts[RED] > 16);
	CHECK(pixel_counts[GREEN] > 16);
	CHECK(pixel_counts[0] == 8);
	const std::pair<uint64_t, uint64_t> CASES[] = { { 2, 1 }, { 1, 2 }, { 0, 2 } };
	for (const auto &[max_part_triangles, continued_part_count] : CASES) {
		CAPTURE(max_part_triangles);
		const Drawn parts = draw_halves(max_part_triangles, /*p_is_conditional=*/false);
		CHECK(parts.continued_part_count == continued_part_count);
		CHECK(parts.colors == whole.colors);
		CHECK(parts.depths == whole.depths);
	}
}

TEST_CASE("[GPU][RenderingDevice] a pass is not divided inside a condition") {
	DeviceFixture fixture;
	if (!fixture.device->get_features().conditional_rendering) {
		MESSAGE("this device has no conditional rendering");
		return;
	}
	const Drawn whole = draw_halves(/*p_max_part_triangles=*/3, /*p_is_conditional=*/false);
	const Drawn conditional = draw_halves(/*p_max_part_triangles=*/1, /*p_is_conditional=*/true);
	CHECK(conditional.continued_part_count == 0);
	CHECK(conditional.colors == whole.colors);
}

TEST_CASE("[GPU][RenderingDevice] only software drivers divide passes") {
	DeviceFixture fixture;
	const auto &device = static_cast<VulkanDevice &>(*fixture.device);
	CHECK((device.max_part_triangles < ~uint64_t(0)) == (device.get_info().type == "CPU"));
}
