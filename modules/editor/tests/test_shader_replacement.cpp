#include "modules/core/embedded_shaders.h"
#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/shader_reload/shader_compiler.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

const std::string NAME = "tests/unused_binding.comp"; // target = source * FACTOR + offset

/// A device, and changed versions of the shader above. Restores the built version at the end.
struct ReplacedShader : DeviceFixture {
	TemporaryFolder folder;
	std::string source = load_text_file("modules/rendering_device/tests/unused_binding.comp");

	~ReplacedShader() { replace_embedded_shader(NAME, {}); }

	/// Compiles the shader with the first p_from in its source replaced by p_to.
	std::vector<uint32_t> compile(const std::string &p_from, const std::string &p_to) {
		std::string text = source;
		const size_t position = text.find(p_from);
		REQUIRE(position != std::string::npos);
		text.replace(position, p_from.size(), p_to);
		std::filesystem::create_directories((folder.path / NAME).parent_path());
		save_file_atomically(folder.path / NAME, std::string_view(text));
		return compile_shader(folder.path, NAME);
	}
	/// Returns the shader's result for source 5 and offset 1; the pipeline sets FACTOR.
	uint32_t run(PipelineRID p_pipeline) {
		const OwnedBuffer source_buffer = make_buffer("source", std::vector<uint32_t>{ 5 });
		const OwnedBuffer target(*device,
				device->create_buffer({ .name = "target",
						.size_bytes = 4,
						.usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE }));
		const OwnedBuffer readback = make_readback(4);
		CommandList &commands = device->begin_commands();
		commands.bind_pipeline(p_pipeline);
		commands.bind_resources({ { 0, source_buffer.get() }, { 1, target.get() } });
		const uint32_t push[] = { 1, 1 }; // item_count, offset
		commands.push_constants(push);
		commands.dispatch_items({ 1, 1, 1 });
		const Barrier barrier = { .buffer = target.get(),
			.before = Access::SHADER_WRITE_COMPUTE,
			.after = Access::COPY_READ };
		commands.barriers({ &barrier, 1 });
		commands.copy_buffer(target.get(), readback.get(), 4);
		device->submit_commands(RenderingDevice::SubmitMode::WAIT);
		return read<uint32_t>(readback, 1).at(0);
	}
};

} // namespace

TEST_CASE("[GPU][RenderingDevice] existing pipeline handles use a replaced shader at once") {
	ReplacedShader fixture;
	// Specialization constants: 0 is the workgroup's size, 1 is FACTOR.
	const ComputePipelineDesc desc = { "scale", NAME, { { 0, 1 }, { 1, 3 } } };
	const PipelineRID pipeline = fixture.device->get_compute_pipeline(desc);
	CHECK(fixture.run(pipeline) == 16);
	fixture.device->replace_shaders({ { NAME, fixture.compile("+ push.offset", "+ 100") } });
	CHECK(fixture.run(pipeline) == 115);
	CHECK(fixture.device->get_compute_pipeline(desc).id == pipeline.id);
	CHECK(get_pipeline_count(*fixture.device) == 1);
	// A pipeline that is created later uses it too.
	CHECK(fixture.run(fixture.device->get_compute_pipeline(
				  { "scale", NAME, { { 0, 1 }, { 1, 4 } } })) == 120);
	// A shader may stop using a binding and use it again later.
	fixture.device->replace_shaders(
			{ { NAME, fixture.compile("source[index] * FACTOR", "FACTOR") } });
	CHECK(fixture.run(pipeline) == 4);
	fixture.device->replace_shaders({ { NAME, fixture.compile("FACTOR", "FACTOR") } }); // unchanged
	CHECK(fixture.run(pipeline) == 16);
}

TEST_CASE("[GPU][RenderingDevice] a replacement that needs other resources than the built shader "
		  "is refused") {
	struct Change {
		std::string from;
		std::string to;
		bool is_refused;
	};
	const std::string unused =
			"layout(std430, set = 0, binding = 7) buffer Unused { uint unused[]; };";
	const std::string more = unused +
			" layout(set = 0, binding = 9) uniform More { uint more; };"
			" layout(std430, set = 0, binding = 9) buffer Other { uint other; };";
	const std::string image =
			"layout(set = 0, binding = 7) uniform sampler2D unused; const uint unused_value = 0;";
	const Change changes[] = {
		{ "= source[index]", "= unused[0] + source[index]", true }, // uses an unused binding
		// More push constants; a binding missing, of another kind, or declared as two kinds.
		{ "uint offset;", "uint offset; uint more[8];", true },
		{ unused, "", true },
		{ unused, image, true },
		{ unused, more, true },
		// A new binding that is declared but not used.
		{ unused, unused + " layout(set = 0, binding = 9) uniform More { uint more; };", false },
	};
	// Without and with an existing pipeline.
	for (const bool has_pipeline : { false, true }) {
		ReplacedShader fixture;
		const ComputePipelineDesc desc = { "scale", NAME, { { 0, 1 }, { 1, 3 } } };
		if (has_pipeline) {
			fixture.device->get_compute_pipeline(desc);
		}
		for (const Change &change : changes) {
			CAPTURE(change.to);
			std::string failure;
			try {
				fixture.device->replace_shaders(
						{ { NAME, fixture.compile(change.from, change.to) } });
			} catch (const Error &error) {
				failure = error.what();
			}
			CHECK(failure.empty() != change.is_refused);
		}
		CHECK(fixture.run(fixture.device->get_compute_pipeline(desc)) == 16);
	}
}
