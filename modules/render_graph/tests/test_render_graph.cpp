#include "modules/core/error.h"
#include "modules/render_graph/compute_pass.h"
#include "modules/render_graph/fill_pass.h"
#include "modules/render_graph/render_graph.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/rendering_device/tests/testing.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

using namespace gnomon;

namespace {

/// A device with validation enabled, and a pool for its graphs.
struct GraphFixture {
	std::unique_ptr<RenderingDevice> device;
	std::unique_ptr<TransientPool> pool;

	explicit GraphFixture(const FeatureList &p_denied = {}) {
		DeviceOptions options;
		options.validation = wants_validation();
		options.denied_features = p_denied;
		device = create_rendering_device(options);
		pool = std::make_unique<TransientPool>(*device);
	}
};

TextureDesc make_desc(const char *p_name, uint32_t p_size_px = 64) {
	return { p_name, Format::R32_SFLOAT, glm::uvec2(p_size_px), 1,
		TextureUsage::COPY_SOURCE | TextureUsage::COPY_TARGET | TextureUsage::SAMPLED };
}

void add_fill(RenderGraph &r_graph, RGTexture p_target, float p_value) {
	r_graph.add_pass("fill")
			.writes(p_target, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.clear_color(p_context.get(p_target), glm::vec4(p_value));
			});
}

void add_copy(RenderGraph &r_graph, RGTexture p_source, RGTexture p_target) {
	r_graph.add_pass("copy")
			.reads(p_source, Access::COPY_READ)
			.writes(p_target, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.copy_texture(p_context.get(p_source), p_context.get(p_target));
			});
}

/// Reads the first texel of a layer on the CPU. The passes that it depends on are not culled.
void add_read(RenderGraph &r_graph, RGTexture p_texture, float &r_value, uint32_t p_layer = 0) {
	const glm::uvec2 size_px = r_graph.get_desc(p_texture).size_px;
	const RGBuffer buffer = r_graph.create_buffer({ "readback", 4ull * size_px.x * size_px.y,
			BufferUsage::COPY_TARGET, MemoryKind::READBACK });
	r_graph.add_pass("read back")
			.reads(p_texture, Access::COPY_READ)
			.writes(buffer, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.copy_texture_to_buffer(
						p_context.get(p_texture), p_context.get(buffer), p_layer);
			});
	r_graph.add_pass("host read")
			.reads(buffer, Access::HOST_READ)
			.keep()
			.execute_on_host([=, &r_value](HostContext &p_context) {
				std::memcpy(&r_value, p_context.get_mapped(buffer), sizeof(float));
			});
}

/// Reads a buffer of words when the graph has run. The passes that it depends on are not culled.
void add_words_read(RenderGraph &r_graph, RGBuffer p_words, std::vector<uint32_t> &r_found) {
	r_graph.add_pass("read words")
			.reads(p_words, Access::COPY_READ)
			.keep()
			.execute([p_words, &r_found](PassContext &p_context) {
				p_context.get_device().read_back(
						p_context.get(p_words), [&r_found](std::span<const uint8_t> p_bytes) {
							std::memcpy(r_found.data(), p_bytes.data(),
									std::min(p_bytes.size(), r_found.size() * sizeof(uint32_t)));
						});
			});
}

} // namespace

TEST_CASE("[GPU][RenderGraph] values pass through a chain of copies in every mode") {
	GraphFixture fixture;
	for (RenderGraph::Mode mode :
			{ RenderGraph::Mode::WAIT, RenderGraph::Mode::ONE_BY_ONE, RenderGraph::Mode::QUEUE }) {
		RenderGraph graph(*fixture.device, *fixture.pool);
		RGTexture texture = graph.create_texture(make_desc("first"));
		add_fill(graph, texture, 0.75f);
		for (int step = 0; step < 5; ++step) {
			const RGTexture next = graph.create_texture(make_desc("next"));
			add_copy(graph, texture, next);
			texture = next;
		}
		float value = 0;
		add_read(graph, texture, value);
		graph.execute(mode);
		CHECK(value == 0.75f);
	}
}

namespace {

/// Runs a chain of copies in three frames. Checks that textures share memory, and that only the
/// first frame allocates.
void check_chain(const FeatureList &p_denied) {
	GraphFixture fixture(p_denied);
	uint64_t used_bytes = 0;
	for (int frame = 0; frame < 3; ++frame) {
		RenderGraph graph(*fixture.device, *fixture.pool);
		RGTexture texture = graph.create_texture(make_desc("first"));
		add_fill(graph, texture, 0.5f);
		for (int step = 0; step < 7; ++step) {
			const RGTexture next = graph.create_texture(make_desc("next"));
			add_copy(graph, texture, next);
			texture = next;
		}
		float value = 0;
		add_read(graph, texture, value);
		graph.execute(RenderGraph::Mode::WAIT);
		CHECK(value == 0.5f);
		// Eight textures, of which two live at a time: a quarter of the memory, plus alignment.
		CHECK(graph.get_aliased_bytes() * 3 <= graph.get_unaliased_bytes());
		if (frame > 0) {
			CHECK(fixture.device->get_memory_use().used_bytes == used_bytes);
		}
		used_bytes = fixture.device->get_memory_use().used_bytes;
	}
}

} // namespace

TEST_CASE("[GPU][RenderGraph] textures of a chain share memory, and the pool reuses it") {
	check_chain({});
}

TEST_CASE("[GPU][RenderGraph] without aliased memory, equal textures of a chain are shared") {
	check_chain({ &DeviceFeatures::aliased_memory });
}

TEST_CASE("[GPU][RenderGraph] a fill reaches every word of a buffer") {
	GraphFixture fixture;
	// Not a multiple of the work group size, 256, and more groups than fit into one row.
	for (const size_t word_count : { size_t(1000), size_t(256) * 65'600 + 3 }) {
		CAPTURE(word_count);
		RenderGraph graph(*fixture.device, *fixture.pool);
		const RGBuffer words = graph.create_buffer({ "words", word_count * sizeof(uint32_t),
				BufferUsage::STORAGE | BufferUsage::COPY_SOURCE });
		add_fill_pass(graph, *fixture.device, "fill", words, 7);
		std::vector<uint32_t> found(word_count);
		add_words_read(graph, words, found);
		graph.execute(RenderGraph::Mode::WAIT);
		CHECK(size_t(std::count(found.begin(), found.end(), 7u)) == word_count);
	}
}

TEST_CASE("[GPU][RenderGraph] each step of a pass sees the results and the indirect arguments of "
		  "the steps before it") {
	GraphFixture fixture;
	const uint32_t step_count = 6;
	const uint32_t group_size = 64;
	const size_t word_count = group_size << (step_count - 1);
	RenderGraph graph(*fixture.device, *fixture.pool);
	const auto make_buffer = [&](const char *p_name, size_t p_count, BufferUsage p_usage) {
		return graph.create_buffer(
				{ p_name, p_count * sizeof(uint32_t), BufferUsage::STORAGE | p_usage });
	};
	const RGBuffer words[2] = { make_buffer("even words", word_count, BufferUsage::COPY_SOURCE),
		make_buffer("odd words", word_count, BufferUsage::COPY_SOURCE) };
	add_fill_pass(graph, *fixture.device, "fill", words[0], 7);
	std::vector<ComputeStep> steps;
	for (uint32_t index = 0; index < step_count; ++index) {
		const RGBuffer arguments = make_buffer("arguments", 3, BufferUsage::INDIRECT);
		ComputeStep step = { .pipeline = fixture.device->get_compute_pipeline(
									 { "steps", "tests/steps.comp", /*constants=*/{} }),
			.bindings = { PassBinding::read(0, words[index % 2]),
					PassBinding::write(1, words[(index + 1) % 2], PassBuilder::Content::UPDATE),
					PassBinding::write(2, arguments) } };
		if (index == 0) {
			step.item_count = { group_size, 1, 1 };
		} else {
			step.arguments = steps.back().bindings[2].buffer;
		}
		steps.push_back(std::move(step));
	}
	add_compute_steps(graph, "steps", std::move(steps));
	add_compute_steps(graph, "no steps", {});
	std::vector<uint32_t> found(word_count);
	add_words_read(graph, words[step_count % 2], found);
	graph.execute(RenderGraph::Mode::WAIT);
	CHECK(found == std::vector<uint32_t>(word_count, 7 + step_count));
	for (const PassTiming &timing : graph.get_timings()) {
		CHECK(timing.name != "no steps");
	}
}

TEST_CASE("[GPU][RenderGraph] a pass whose result is unused does not run, nor do its sources") {
	GraphFixture fixture;
	RenderGraph graph(*fixture.device, *fixture.pool);
	const RGTexture unused = graph.create_texture(make_desc("unused"));
	const RGTexture unused_copy = graph.create_texture(make_desc("unused copy"));
	const RGTexture used = graph.create_texture(make_desc("used"));
	add_fill(graph, unused, 1.0f);
	add_copy(graph, unused, unused_copy);
	add_fill(graph, used, 2.0f);
	float value = 0;
	add_read(graph, used, value);
	graph.execute(RenderGraph::Mode::WAIT);
	CHECK(value == 2.0f);
	CHECK(graph.get_culled_passes() == std::vector<std::string>{ "fill", "copy" });
	CHECK(graph.to_dot().find("style=dashed") != std::string::npos);
}

TEST_CASE("[GPU][RenderGraph] a pass that declares a fresh write and an update needs the content") {
	GraphFixture fixture;
	RenderGraph graph(*fixture.device, *fixture.pool);
	const RGTexture texture = graph.create_texture(make_desc("twice"));
	add_fill(graph, texture, 3.0f);
	graph.add_pass("update")
			.writes(texture, Access::SHADER_WRITE_COMPUTE, PassBuilder::Content::FRESH)
			.writes(texture, Access::SHADER_WRITE_COMPUTE, PassBuilder::Content::UPDATE)
			.execute([](PassContext &) {});
	float value = 0;
	add_read(graph, texture, value);
	graph.execute(RenderGraph::Mode::WAIT);
	CHECK(graph.get_culled_passes().empty());
	CHECK(value == 3.0f);
}

TEST_CASE("[GPU][RenderGraph] an imported texture keeps its content from frame to frame") {
	GraphFixture fixture;
	OwnedTexture imported(*fixture.device, fixture.device->create_texture(make_desc("imported")));
	{
		RenderGraph graph(*fixture.device, *fixture.pool);
		add_fill(graph, graph.import_texture(imported.get(), RenderGraph::ImportedContent::NONE),
				3.0f);
		graph.execute(RenderGraph::Mode::QUEUE);
	}
	RenderGraph graph(*fixture.device, *fixture.pool);
	const RGTexture texture =
			graph.import_texture(imported.get(), RenderGraph::ImportedContent::PRESERVED);
	const RGTexture copy = graph.create_texture(make_desc("copy"));
	add_copy(graph, texture, copy);
	float value = 0;
	add_read(graph, copy, value);
	graph.execute(RenderGraph::Mode::WAIT);
	CHECK(value == 3.0f);
}

TEST_CASE("[GPU][RenderGraph] a buffer that is imported twice has one handle, as its users share "
		  "barriers") {
	GraphFixture fixture;
	RenderGraph graph(*fixture.device, *fixture.pool);
	const OwnedBuffer first(*fixture.device, fixture.device->create_buffer({ "first", 16 }));
	const OwnedBuffer second(*fixture.device, fixture.device->create_buffer({ "second", 16 }));
	const RGBuffer handle = graph.import_buffer(first.get());
	CHECK(graph.import_buffer(second.get()) != handle);
	CHECK(graph.import_buffer(first.get()) == handle);
	CHECK(graph.get_desc(handle).name == "first");
}

TEST_CASE("[GPU][RenderGraph] drawing one layer of an array leaves the other layers as they were") {
	GraphFixture fixture;
	RenderGraph graph(*fixture.device, *fixture.pool);
	TextureDesc desc = make_desc("array");
	desc.layer_count = 3;
	desc.is_array = true;
	desc.usage = desc.usage | TextureUsage::COLOR_ATTACHMENT;
	const RGTexture array = graph.create_texture(desc);
	for (uint32_t layer = 0; layer < 3; ++layer) {
		graph.add_pass("clear a layer")
				.color(array, LoadOp::CLEAR, glm::vec4(1.0f + float(layer)), layer)
				.execute([](PassContext &) {});
	}
	float values[3] = {};
	for (uint32_t layer = 0; layer < 3; ++layer) {
		add_read(graph, array, values[layer], layer);
	}
	graph.execute(RenderGraph::Mode::WAIT);
	for (uint32_t layer = 0; layer < 3; ++layer) {
		CHECK(values[layer] == 1.0f + float(layer));
	}
}

TEST_CASE("[GPU][RenderGraph] passes have names and times, and wall time when run one by one") {
	GraphFixture fixture;
	RenderGraph graph(*fixture.device, *fixture.pool);
	graph.set_pass_prefix("Lamp: ");
	const RGTexture texture = graph.create_texture(make_desc("big", 512));
	add_fill(graph, texture, 1.0f);
	float value = 0;
	add_read(graph, texture, value);
	graph.execute(RenderGraph::Mode::ONE_BY_ONE);
	REQUIRE(graph.get_timings().size() == 3); // fill, read back, host read
	CHECK(graph.get_timings()[0].name == "Lamp: fill");
	CHECK((graph.get_timings()[0].gpu_ms > 0) == fixture.device->get_features().timestamps);
	CHECK(graph.get_timings()[0].wall_ms > 0);
	CHECK(graph.get_wall_ms() >= graph.get_timings()[0].wall_ms);
}

TEST_CASE("[GPU][RenderGraph] an error in a pass ends the frame, and the next frame works") {
	GraphFixture fixture;
	{
		RenderGraph graph(*fixture.device, *fixture.pool);
		const RGTexture texture = graph.create_texture(make_desc("texture"));
		graph.add_pass("bad").writes(texture, Access::COPY_WRITE).keep().execute([](PassContext &) {
			fail("Pass: broken on purpose.");
		});
		CHECK_THROWS_AS(graph.execute(RenderGraph::Mode::WAIT), Error);
	}
	RenderGraph graph(*fixture.device, *fixture.pool);
	const RGTexture texture = graph.create_texture(make_desc("texture"));
	add_fill(graph, texture, 4.0f);
	float value = 0;
	add_read(graph, texture, value);
	graph.execute(RenderGraph::Mode::WAIT);
	CHECK(value == 4.0f);
}

TEST_CASE("[GPU][RenderGraph] a lost device is reported with the last pass that began") {
	GraphFixture fixture;
	inject_fault(*fixture.device, "device_lost");
	RenderGraph graph(*fixture.device, *fixture.pool);
	const RGTexture texture = graph.create_texture(make_desc("texture"));
	add_fill(graph, texture, 4.0f);
	float value = 0;
	add_read(graph, texture, value);
	std::string message;
	try {
		graph.execute(RenderGraph::Mode::WAIT);
	} catch (const Error &error) {
		message = error.what();
	}
	CHECK_MESSAGE(message.find("read back") != std::string::npos, message);
}
