#include "modules/rendering_device/tests/triangle_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

const uint32_t SIDE_PX = 8;
const float CLEAR_DEPTH = 0.75f; // clear value; TRIANGLE is nearer, at 0.25

/// Draws triangles that count in a stencil buffer, then one where the count is not 0.
struct StencilFixture : DeviceFixture {
	OwnedTexture color, depth;
	OwnedBuffer vertices;

	explicit StencilFixture(const FeatureList &p_denied = {}) : DeviceFixture({}, p_denied) {
		color = OwnedTexture(*device,
				device->create_texture({ .name = "color",
						.size_px = glm::uvec2(SIDE_PX),
						.usage = TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE }));
		depth = OwnedTexture(*device,
				device->create_texture({ .name = "depth and stencil",
						.format = Format::D32_SFLOAT_S8_UINT,
						.size_px = glm::uvec2(SIDE_PX),
						.usage = TextureUsage::DEPTH_ATTACHMENT }));
		vertices = make_buffer("vertices", TRIANGLE, BufferUsage::VERTEX);
	}

	RasterPipelineDesc make_desc(const char *p_name, StencilTest p_stencil) const {
		RasterPipelineDesc desc = make_triangle_desc();
		desc.name = p_name;
		desc.has_stencil = true;
		desc.stencil = p_stencil;
		desc.writes_depth = false;
		return desc;
	}

	/// Draws the triangle p_times with the counting pipeline, and if p_with_mirrored also p_times
	/// with the opposite winding. Then draws it where the stencil is not 0 and returns the number
	/// of texels. p_reference: stencil reference of the counting pipelines.
	size_t count_drawn(const RasterPipelineDesc &p_counting, uint32_t p_times,
			bool p_with_mirrored = false, uint32_t p_reference = 0) {
		RasterPipelineDesc counting = p_counting;
		counting.stencil.reference = p_reference;
		const StencilFace not_zero = { .compare = CompareOp::NOT_EQUAL };
		RasterPipelineDesc drawing = make_desc("drawing", { not_zero, not_zero });
		const PipelineRID count_pipeline = device->get_raster_pipeline(counting);
		counting.winding = Winding::MIRRORED;
		const PipelineRID mirrored_pipeline = device->get_raster_pipeline(counting);
		const PipelineRID draw_pipeline = device->get_raster_pipeline(drawing);
		CommandList &commands = device->begin_commands();
		const Barrier before[] = { { .texture = color.get(), .after = Access::COLOR_WRITE },
			{ .texture = depth.get(), .after = Access::DEPTH_WRITE } };
		commands.barriers(before);
		const ColorTarget color_target = { color.get() };
		const DepthTarget depth_target = { .texture = depth.get(), .clear = CLEAR_DEPTH };
		commands.begin_rendering({ &color_target, 1 }, &depth_target);
		for (uint32_t time = 0; time < p_times; ++time) {
			draw_triangle(commands, count_pipeline, vertices.get());
			if (p_with_mirrored) {
				draw_triangle(commands, mirrored_pipeline, vertices.get());
			}
		}
		commands.end_rendering();
		// Cleared again: only what the last draw covers is counted.
		const ColorTarget second_color = { color.get(), LoadOp::CLEAR };
		const DepthTarget second_depth = { .texture = depth.get(), .load = LoadOp::KEEP };
		commands.begin_rendering({ &second_color, 1 }, &second_depth);
		draw_triangle(commands, draw_pipeline, vertices.get());
		commands.end_rendering();
		device->submit_commands(SubmitMode::WAIT);
		const auto texels = read_texture<uint32_t>(color.get(), Access::COLOR_WRITE);
		return size_t(std::count_if(
				texels.begin(), texels.end(), [](uint32_t p_texel) { return p_texel != 0; }));
	}
};

StencilTest make_passing(StencilOp p_front, StencilOp p_back) {
	StencilTest test;
	test.front.pass = p_front;
	test.back.pass = p_back;
	return test;
}

} // namespace

TEST_CASE("[GPU][RenderingDevice] a stencil counts, wraps at 256 and masks later draws") {
	StencilFixture fixture;
	const RasterPipelineDesc counting = fixture.make_desc(
			"counting", make_passing(StencilOp::INCREMENT_WRAP, StencilOp::INCREMENT_WRAP));
	const size_t covered = fixture.count_drawn(counting, 1);
	CHECK(covered > SIDE_PX);
	CHECK(covered < SIDE_PX * SIDE_PX);
	CHECK(fixture.count_drawn(counting, 0) == 0);
	CHECK(fixture.count_drawn(counting, 255) == covered);
	CHECK(fixture.count_drawn(counting, 256) == 0);
}

TEST_CASE("[GPU][RenderingDevice] front and back faces have their own stencil operations") {
	StencilFixture fixture;
	const RasterPipelineDesc both = fixture.make_desc("front up, back down",
			make_passing(StencilOp::INCREMENT_WRAP, StencilOp::DECREMENT_WRAP));
	CHECK(fixture.count_drawn(both, 3) != 0);
	CHECK(fixture.count_drawn(both, 3, /*p_with_mirrored=*/true) == 0); // as often up as down
}

TEST_CASE("[GPU][RenderingDevice] the stencil reference is written by REPLACE and used in "
		  "comparisons") {
	StencilFixture fixture;
	const RasterPipelineDesc writing =
			fixture.make_desc("writing", make_passing(StencilOp::REPLACE, StencilOp::REPLACE));
	CHECK(fixture.count_drawn(writing, 1, /*p_with_mirrored=*/false, 0) == 0);
	CHECK(fixture.count_drawn(writing, 1, /*p_with_mirrored=*/false, 7) != 0);
	StencilTest test = make_passing(StencilOp::INCREMENT_WRAP, StencilOp::INCREMENT_WRAP);
	test.front.compare = test.back.compare = CompareOp::EQUAL;
	const RasterPipelineDesc comparing = fixture.make_desc("comparing", test);
	CHECK(fixture.count_drawn(comparing, 1, /*p_with_mirrored=*/false, 0) != 0);
	CHECK(fixture.count_drawn(comparing, 1, /*p_with_mirrored=*/false, 1) == 0);
}

TEST_CASE(
		"[GPU][RenderingDevice] fragments that fail the depth test use the depth_fail operation") {
	StencilFixture fixture;
	StencilTest test;
	test.front.depth_fail = test.back.depth_fail = StencilOp::INCREMENT_WRAP;
	RasterPipelineDesc failing = fixture.make_desc("failing", test);
	CHECK(fixture.count_drawn(failing, 1) == 0); // nearer: all pass
	failing.depth_compare = CompareOp::GREATER;
	CHECK(fixture.count_drawn(failing, 1) != 0);
}

TEST_CASE("[GPU][RenderingDevice] a pipeline with depth bounds draws within the default ones, and "
		  "is refused if the device has none") {
	StencilFixture fixture;
	RasterPipelineDesc bounded = fixture.make_desc(
			"bounded", make_passing(StencilOp::INCREMENT_WRAP, StencilOp::INCREMENT_WRAP));
	bounded.has_depth_bounds = true;
	if (fixture.device->get_features().depth_bounds) {
		CHECK(fixture.count_drawn(bounded, 1) != 0); // the default bounds are 0 to 1
	} else {
		CHECK(contains(catch_error([&] { fixture.device->get_raster_pipeline(bounded); }),
				"needs depth bounds"));
	}
	StencilFixture limited({ &DeviceFeatures::depth_bounds });
	CHECK_FALSE(limited.device->get_features().depth_bounds);
	RasterPipelineDesc refused = limited.make_desc(
			"bounded", make_passing(StencilOp::INCREMENT_WRAP, StencilOp::INCREMENT_WRAP));
	refused.has_depth_bounds = true;
	CHECK(contains(catch_error([&] { limited.device->get_raster_pipeline(refused); }),
			"needs depth bounds"));
}
