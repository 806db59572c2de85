#pragma once

#include "modules/rendering_device/tests/device_fixture.h"

#include "tests/test_random.h"

#include <glm/glm.hpp>

#include <vector>

namespace gnomon {

/// Runs a compute kernel of tests/shaders. Binding 0 is its input and 1 its output, both arrays of
/// vec4. Binding 2 is a block of constants, if the kernel has one. Each invocation computes one
/// item, which may have several vec4 of input and p_output_per_item of output.
struct KernelFixture : DeviceFixture {
	static constexpr uint32_t BINDING_INPUT = 0;
	static constexpr uint32_t BINDING_OUTPUT = 1;
	static constexpr uint32_t BINDING_CONSTANTS = 2;

	std::vector<glm::vec4> run(const std::string &p_kernel, const std::vector<glm::vec4> &p_input,
			size_t p_item_count, size_t p_output_per_item,
			std::vector<Binding> p_more_bindings = {},
			std::vector<SpecializationConstant> p_constants = {}) {
		const uint64_t size_bytes = p_item_count * p_output_per_item * sizeof(glm::vec4);
		const OwnedBuffer input = make_buffer("kernel input", p_input);
		const OwnedBuffer output(*device,
				device->create_buffer({ .name = "kernel output",
						.size_bytes = size_bytes,
						.usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE }));
		const OwnedBuffer readback = make_readback(size_bytes);
		const PipelineRID pipeline = device->get_compute_pipeline({ .name = p_kernel,
				.shader = "tests/" + p_kernel,
				.constants = std::move(p_constants) });
		p_more_bindings.push_back({ BINDING_INPUT, input.get() });
		p_more_bindings.push_back({ BINDING_OUTPUT, output.get() });
		CommandList &commands = device->begin_commands();
		commands.bind_pipeline(pipeline);
		commands.bind_resources(p_more_bindings);
		commands.dispatch_items({ p_item_count, 1, 1 });
		const Barrier barrier = { .buffer = output.get(),
			.before = Access::SHADER_WRITE_COMPUTE,
			.after = Access::COPY_READ };
		commands.barriers({ &barrier, 1 });
		commands.copy_buffer(output.get(), readback.get(), size_bytes);
		device->submit_commands(RenderingDevice::SubmitMode::WAIT);
		return read<glm::vec4>(readback, p_item_count * p_output_per_item);
	}

	template <typename T>
	std::vector<glm::vec4> run_with_constants(const std::string &p_kernel, const T &p_constants,
			const std::vector<glm::vec4> &p_input, size_t p_item_count, size_t p_output_per_item) {
		const OwnedBuffer constants = make_buffer(
				"kernel constants", std::vector<T>{ p_constants }, BufferUsage::STORAGE);
		return run(p_kernel, p_input, p_item_count, p_output_per_item,
				{ { BINDING_CONSTANTS, constants.get() } });
	}
};

} // namespace gnomon
