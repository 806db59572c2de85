#include "modules/rendering_device/tests/triangle_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace gnomon;
using SubmitMode = RenderingDevice::SubmitMode;

namespace {

/// Push constants of scale.comp.
struct ScalePush {
	uint32_t item_count;
	uint32_t offset;
};

const uint32_t FACTOR = 3; // of scale.comp

PipelineRID get_scale_pipeline(RenderingDevice &r_device, uint32_t p_local_size = 64) {
	return r_device.get_compute_pipeline({ .name = "scale",
			.shader = "tests/scale.comp",
			.constants = { { 0, p_local_size }, { 1, FACTOR } } });
}

} // namespace

TEST_CASE("[GPU][RenderingDevice] a compute pass reads uploaded data and its result can be read") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	std::vector<uint32_t> values(1000);
	for (uint32_t index = 0; index < values.size(); ++index) {
		values[index] = index * index;
	}
	const OwnedBuffer source = fixture.make_buffer("source", values);
	const OwnedBuffer target(device,
			device.create_buffer({ .name = "target",
					.size_bytes = 4000,
					.usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE }));
	const OwnedBuffer readback = fixture.make_readback(4000);
	const uint32_t pipeline_count = get_pipeline_count(device);
	for (const uint32_t local_size : { 64u, 7u }) {
		CommandList &commands = device.begin_commands();
		commands.bind_pipeline(get_scale_pipeline(device, local_size));
		commands.bind_resources({ { 0, source.get() }, { 1, target.get() } });
		commands.push_constants(ScalePush{ 1000, local_size });
		commands.dispatch_items({ 1000, 1, 1 });
		const Barrier barrier = { .buffer = target.get(),
			.before = Access::SHADER_WRITE_COMPUTE,
			.after = Access::COPY_READ };
		commands.barriers({ &barrier, 1 });
		commands.copy_buffer(target.get(), readback.get(), 4000);
		device.submit_commands(SubmitMode::WAIT);
		const auto results = fixture.read<uint32_t>(readback, 1000);
		bool is_equal = true;
		for (uint32_t index = 0; index < values.size(); ++index) {
			is_equal = is_equal && results[index] == values[index] * FACTOR + local_size;
		}
		CHECK(is_equal);
	}
	CHECK(get_pipeline_count(device) == pipeline_count + 2);
	get_scale_pipeline(device);
	CHECK(get_pipeline_count(device) == pipeline_count + 2);
}

TEST_CASE("[GPU][RenderingDevice] an upload made during recording is visible to the recorded "
		  "commands") {
	DeviceFixture fixture;
	const OwnedBuffer readback = fixture.make_readback(16);
	CommandList &commands = fixture.device->begin_commands();
	const OwnedBuffer source = fixture.make_buffer(
			"source", std::vector<uint32_t>{ 1, 2, 3, 4 }, BufferUsage::COPY_SOURCE);
	commands.copy_buffer(source.get(), readback.get(), 16);
	fixture.device->submit_commands(SubmitMode::WAIT);
	CHECK(fixture.read<uint32_t>(readback, 4) == std::vector<uint32_t>{ 1, 2, 3, 4 });
}

TEST_CASE("[GPU][RenderingDevice] an upload larger than the staging limit arrives completely") {
	DeviceFixture fixture;
	std::vector<uint32_t> values(18u << 20); // 72 MiB, staged in two parts
	for (uint32_t index = 0; index < values.size(); ++index) {
		values[index] = index;
	}
	const uint64_t size_bytes = values.size() * sizeof(uint32_t);
	const OwnedBuffer readback = fixture.make_readback(size_bytes);
	const auto check = [&](const OwnedBuffer &p_source, CommandList &r_commands) {
		r_commands.copy_buffer(p_source.get(), readback.get(), size_bytes);
		fixture.device->submit_commands(SubmitMode::WAIT);
		CHECK(fixture.read<uint32_t>(readback, values.size()) == values);
	};
	const OwnedBuffer before = fixture.make_buffer("before", values, BufferUsage::COPY_SOURCE);
	check(before, fixture.device->begin_commands());
	std::reverse(values.begin(), values.end());
	CommandList &commands = fixture.device->begin_commands();
	const OwnedBuffer meanwhile = fixture.make_buffer("while", values, BufferUsage::COPY_SOURCE);
	check(meanwhile, commands);
	CHECK(get_validation_message_count() == 0);
}

TEST_CASE("[GPU][RenderingDevice] freeing a resource before its upload ran cancels the upload") {
	DeviceFixture fixture;
	const uint64_t used_before = fixture.device->get_memory_use().used_bytes;
	fixture.make_buffer("short-lived", std::vector<uint32_t>(1000));
	CHECK(fixture.device->get_memory_use().used_bytes == used_before);
	fixture.device->begin_commands();
	fixture.device->submit_commands(SubmitMode::WAIT);
}

TEST_CASE("[GPU][RenderingDevice] textures of every format that can be copied keep their texels") {
	DeviceFixture fixture;
	for (int index = 0; index <= static_cast<int>(Format::D32_SFLOAT); ++index) {
		const Format format = static_cast<Format>(index);
		CAPTURE(get_format_name(format));
		// 5 x 3 texels: rows of odd length. Bytes below 60 give finite halves and floats.
		std::vector<uint8_t> bytes(15 * get_texel_size_bytes(format));
		for (size_t byte = 0; byte < bytes.size(); ++byte) {
			bytes[byte] = static_cast<uint8_t>(byte % 60);
		}
		const OwnedTexture texture(*fixture.device,
				fixture.device->create_texture_with_data(
						{ .name = "texture",
								.format = format,
								.size_px = { 5, 3 },
								.usage = TextureUsage::COPY_SOURCE },
						bytes));
		CHECK(fixture.read_texture<uint8_t>(texture.get(), Access::SHADER_READ_FRAGMENT) == bytes);
	}
}

TEST_CASE("[GPU][RenderingDevice] uniform, texel, texture and sampler bindings reach the shader") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer constants = fixture.make_buffer(
			"constants", std::vector<uint32_t>{ 1000, 0, 0, 0 }, BufferUsage::UNIFORM);
	const OwnedBuffer texels = fixture.make_buffer(
			"texels", std::vector<uint32_t>{ 0, 10, 20, 30, 40 }, BufferUsage::TEXEL);
	const std::vector<float> combined_values = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14 };
	const OwnedTexture combined(device,
			device.create_texture_with_data(
					{ .name = "combined", .format = Format::R32_SFLOAT, .size_px = { 5, 3 } },
					bytes_of(std::span(combined_values))));
	const std::vector<float> layer_values = { 5, 100 };
	const OwnedTexture layers(device,
			device.create_texture_with_data({ .name = "layers",
													.format = Format::R32_SFLOAT,
													.layer_count = 2,
													.is_array = true },
					bytes_of(std::span(layer_values))));
	const OwnedSampler sampler(device, device.create_sampler({ .name = "nearest" }));
	const OwnedTexture result(device,
			device.create_texture({ .name = "result",
					.format = Format::R32_SFLOAT,
					.size_px = { 5, 3 },
					.usage = TextureUsage::STORAGE | TextureUsage::COPY_SOURCE }));
	CommandList &commands = device.begin_commands();
	const Barrier barriers[] = {
		{ .texture = result.get(), .after = Access::SHADER_WRITE_COMPUTE },
		{ .texture = combined.get(),
				.before = Access::SHADER_READ_FRAGMENT,
				.after = Access::SHADER_READ_COMPUTE },
		{ .texture = layers.get(),
				.before = Access::SHADER_READ_FRAGMENT,
				.after = Access::SHADER_READ_COMPUTE },
	};
	commands.barriers(barriers);
	commands.bind_pipeline(
			device.get_compute_pipeline({ .name = "bindings", .shader = "tests/bindings.comp" }));
	commands.bind_resources(
			{ { 0, constants.get() }, { 1, texels.get() }, { 2, combined.get(), sampler.get() },
					{ 3, layers.get() }, { 4, sampler.get() }, { 5, result.get() } });
	commands.dispatch_items({ 5, 3, 1 });
	device.submit_commands(SubmitMode::WAIT);
	const auto values = fixture.read_texture<float>(result.get(), Access::SHADER_WRITE_COMPUTE);
	for (size_t index = 0; index < values.size(); ++index) {
		CHECK(values[index] == 1100.0f + 10.0f * float(index % 5) + float(index));
	}
}

TEST_CASE("[GPU][RenderingDevice] a triangle covers its half of the colour and depth targets") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer vertices = fixture.make_buffer("vertices", TRIANGLE, BufferUsage::VERTEX);
	TriangleTargets targets(fixture);
	RasterPipelineDesc desc = make_triangle_desc();
	uint32_t vertex_count = 3;
	OwnedBuffer adjacent;
	SUBCASE("vertex and fragment stage") {}
	SUBCASE("geometry stage") {
		desc.geometry_shader = "tests/triangle.geom";
		desc.topology = Topology::TRIANGLES_WITH_ADJACENCY;
		std::vector<float> with_neighbours;
		for (size_t corner = 0; corner < 3; ++corner) {
			for (size_t copy = 0; copy < 2; ++copy) {
				with_neighbours.insert(with_neighbours.end(), TRIANGLE.begin() + corner * 3,
						TRIANGLE.begin() + corner * 3 + 3);
			}
		}
		adjacent = fixture.make_buffer("adjacent", with_neighbours, BufferUsage::VERTEX);
		vertex_count = 6;
	}
	CommandList &commands = device.begin_commands();
	commands.barriers(targets.get_barriers());
	const ColorTarget color = { .texture = targets.color.get(), .clear = glm::vec4(0, 0, 1, 1) };
	const DepthTarget depth = { .texture = targets.depth.get() };
	commands.begin_rendering({ &color, 1 }, &depth);
	commands.bind_pipeline(device.get_raster_pipeline(desc));
	commands.push_constants(glm::vec4(1, 0, 0, 1));
	const BufferRID buffer = adjacent ? adjacent.get() : vertices.get();
	commands.bind_vertex_buffers({ &buffer, 1 });
	commands.draw(vertex_count);
	commands.end_rendering();
	device.submit_commands(SubmitMode::WAIT);
	const auto colors = fixture.read_texture<uint32_t>(targets.color.get(), Access::COLOR_WRITE);
	const auto depths = fixture.read_texture<float>(targets.depth.get(), Access::DEPTH_WRITE);
	CHECK(colors[0] == 0xff0000ffu); // red, inside
	CHECK(depths[0] == 0.25f);
	CHECK(colors[63] == 0xffff0000u); // blue, outside
	CHECK(depths[63] == 1.0f);
}

TEST_CASE("[GPU][RenderingDevice] culling follows the winding as seen in the image") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	// Top left, bottom left, top right of the image: counter-clockwise to the eye.
	const OwnedBuffer vertices = fixture.make_buffer("vertices", TRIANGLE, BufferUsage::VERTEX);
	TriangleTargets targets(fixture);
	const auto draw = [&](CullMode p_cull, Winding p_winding) {
		RasterPipelineDesc desc = make_triangle_desc();
		desc.cull_mode = p_cull;
		desc.winding = p_winding;
		CommandList &commands = device.begin_commands();
		commands.barriers(targets.get_barriers());
		const ColorTarget color = { .texture = targets.color.get() };
		const DepthTarget depth = { .texture = targets.depth.get() };
		commands.begin_rendering({ &color, 1 }, &depth);
		draw_triangle(commands, device.get_raster_pipeline(desc), vertices.get());
		commands.end_rendering();
		device.submit_commands(SubmitMode::WAIT);
		return fixture.read_texture<uint32_t>(targets.color.get(), Access::COLOR_WRITE)[0] != 0;
	};
	CHECK(draw(CullMode::BACK, Winding::NORMAL));
	CHECK_FALSE(draw(CullMode::FRONT, Winding::NORMAL));
	CHECK_FALSE(draw(CullMode::BACK, Winding::MIRRORED));
	CHECK(draw(CullMode::NONE, Winding::MIRRORED));
}

TEST_CASE("[GPU][RenderingDevice] a depth target that is only tested against keeps its content") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer vertices = fixture.make_buffer("vertices", TRIANGLE, BufferUsage::VERTEX);
	TriangleTargets targets(fixture);
	RasterPipelineDesc desc = make_triangle_desc();
	desc.writes_depth = false;
	CommandList &commands = device.begin_commands();
	commands.barriers(targets.get_barriers());
	const ColorTarget color = { .texture = targets.color.get() };
	DepthTarget depth = { .texture = targets.depth.get(), .clear = 0.1f };
	commands.begin_rendering({ &color, 1 }, &depth);
	commands.end_rendering();
	const Barrier barriers[] = {
		{ .texture = targets.color.get(),
				.before = Access::COLOR_WRITE,
				.after = Access::COLOR_WRITE },
		{ .texture = targets.depth.get(),
				.before = Access::DEPTH_WRITE,
				.after = Access::DEPTH_READ },
	};
	commands.barriers(barriers);
	depth.load = LoadOp::KEEP;
	commands.begin_rendering({ &color, 1 }, &depth);
	draw_triangle(commands, device.get_raster_pipeline(desc), vertices.get());
	commands.end_rendering();
	device.submit_commands(SubmitMode::WAIT);
	CHECK(fixture.read_texture<uint32_t>(targets.color.get(), Access::COLOR_WRITE)[0] == 0);
	CHECK(fixture.read_texture<float>(targets.depth.get(), Access::DEPTH_READ)[0] == 0.1f);
}

TEST_CASE("[GPU][RenderingDevice] fragments can be counted without any target") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer vertices = fixture.make_buffer("vertices", TRIANGLE, BufferUsage::VERTEX);
	const OwnedBuffer count = fixture.make_buffer(
			"count", std::vector<uint32_t>{ 0 }, BufferUsage::STORAGE | BufferUsage::COPY_SOURCE);
	const OwnedBuffer readback = fixture.make_readback(4);
	RasterPipelineDesc desc = make_triangle_desc();
	desc.fragment_shader = "tests/store.frag";
	desc.color_formats.clear();
	desc.has_depth = false;
	CommandList &commands = device.begin_commands();
	commands.begin_rendering_without_targets(glm::uvec2(16));
	commands.bind_pipeline(device.get_raster_pipeline(desc));
	commands.bind_resources({ { 0, count.get() } });
	commands.push_constants(glm::vec4(1)); // store.frag adds x for each fragment
	const BufferRID buffer = vertices.get();
	commands.bind_vertex_buffers({ &buffer, 1 });
	commands.draw(3);
	commands.end_rendering();
	const Barrier barrier = {
		.buffer = count.get(), .before = Access::SHADER_WRITE_FRAGMENT, .after = Access::COPY_READ
	};
	commands.barriers({ &barrier, 1 });
	commands.copy_buffer(count.get(), readback.get(), 4);
	device.submit_commands(SubmitMode::WAIT);
	const uint32_t found = fixture.read<uint32_t>(readback, 1)[0];
	CHECK(found >= 120); // half of 256 texels, with or without the diagonal
	CHECK(found <= 136);
}

TEST_CASE("[GPU][RenderingDevice] cleared and copied textures have the cleared value") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const TextureDesc desc = { .name = "target",
		.format = Format::RG32_UINT,
		.size_px = glm::uvec2(2),
		.usage = TextureUsage::COPY_SOURCE | TextureUsage::COPY_TARGET };
	const OwnedTexture first(device, device.create_texture(desc));
	const OwnedTexture second(device, device.create_texture(desc));
	CommandList &commands = device.begin_commands();
	const Barrier before[] = {
		{ .texture = first.get(), .after = Access::COPY_WRITE },
		{ .texture = second.get(), .after = Access::COPY_WRITE },
	};
	commands.barriers(before);
	commands.clear_color(first.get(), glm::vec4(7, 9, 0, 0));
	const Barrier between = {
		.texture = first.get(), .before = Access::COPY_WRITE, .after = Access::COPY_READ
	};
	commands.barriers({ &between, 1 });
	commands.copy_texture(first.get(), second.get());
	device.submit_commands(SubmitMode::WAIT);
	CHECK(fixture.read_texture<uint32_t>(second.get(), Access::COPY_WRITE) ==
			std::vector<uint32_t>{ 7, 9, 7, 9, 7, 9, 7, 9 });
}

TEST_CASE("[GPU][RenderingDevice] a depth texture is filled from the middle of a buffer") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const OwnedBuffer source = fixture.make_buffer("source",
			std::vector<float>{ 9, 9, 9, 9, 0.25f, 0.5f, 0.75f, 1 }, BufferUsage::COPY_SOURCE);
	const OwnedTexture texture(device,
			device.create_texture({ .name = "depth",
					.format = Format::D32_SFLOAT,
					.size_px = glm::uvec2(2),
					.usage = TextureUsage::DEPTH_ATTACHMENT | TextureUsage::COPY_SOURCE |
							TextureUsage::COPY_TARGET }));
	CommandList &commands = device.begin_commands();
	const Barrier barrier = { .texture = texture.get(), .after = Access::COPY_WRITE };
	commands.barriers({ &barrier, 1 });
	commands.copy_buffer_to_texture(source.get(), texture.get(), /*p_layer=*/0, 4 * sizeof(float));
	device.submit_commands(SubmitMode::WAIT);
	CHECK(fixture.read_texture<float>(texture.get(), Access::COPY_WRITE) ==
			std::vector<float>{ 0.25f, 0.5f, 0.75f, 1 });
}
