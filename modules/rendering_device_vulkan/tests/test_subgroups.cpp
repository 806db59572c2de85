#include "modules/core/embedded_shaders.h"
#include "modules/rendering_device/tests/device_fixture.h"
#include "modules/rendering_device_vulkan/pipeline_stages.h"

#include <doctest/doctest.h>
#include <spirv_cross/spirv.hpp>

#include <algorithm>

using namespace gnomon;

namespace {

const uint32_t LOCAL_SIZE_ID = 0; // constant_id of the work group's size in subgroups.comp

/// Adds the shader to a pipeline's stages, and checks what the stage requests.
void check_request(const DeviceFixture &p_fixture, const std::string &p_shader,
		uint32_t p_local_size, bool p_has_size, bool p_has_full_subgroups) {
	auto &device = static_cast<VulkanDevice &>(*p_fixture.device);
	const std::vector<SpecializationConstant> constants = { { LOCAL_SIZE_ID, p_local_size } };
	PipelineStages stages(device, constants);
	stages.add(p_shader, VK_SHADER_STAGE_COMPUTE_BIT);
	const VkPipelineShaderStageCreateInfo &info = stages.get_infos()[0];
	const auto *size =
			static_cast<const VkPipelineShaderStageRequiredSubgroupSizeCreateInfo *>(info.pNext);
	REQUIRE((size != nullptr) == p_has_size);
	if (p_has_size) {
		CHECK(size->requiredSubgroupSize == device.get_features().subgroup_size);
	}
	const bool is_full =
			(info.flags & VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT) != 0;
	CHECK(is_full == p_has_full_subgroups);
}

std::vector<uint32_t> list_ops(std::span<const uint32_t> p_words) {
	std::vector<uint32_t> ops;
	for (size_t at = 5; at < p_words.size(); at += p_words[at] >> 16) {
		ops.push_back(p_words[at] & 0xffffu);
	}
	return ops;
}

} // namespace

TEST_CASE("[RenderingDevice] subgroups of 32 are chosen where the device allows them, else the "
		  "nearest size") {
	const struct {
		const char *device;
		SubgroupSizes sizes;
		uint32_t chosen;
	} ROWS[] = {
		{ "NVIDIA", { 32, 32, 32, true }, 32 },
		{ "AMD from RDNA on", { 64, 32, 64, true }, 32 },
		{ "AMD before RDNA", { 64, 64, 64, true }, 64 },
		{ "Intel", { 32, 8, 32, true }, 32 },
		{ "Intel with at most 16", { 16, 8, 16, true }, 16 },
		{ "Qualcomm", { 64, 64, 128, true }, 64 },
		{ "llvmpipe", { 8, 8, 8, true }, 8 },
		{ "no request for compute", { 64, 32, 64, false }, 64 },
	};
	for (const auto &row : ROWS) {
		CAPTURE(row.device);
		CHECK(choose_subgroup_size(row.sizes) == row.chosen);
	}
}

TEST_CASE("[GPU][RenderingDevice] compute shaders with subgroup operations request the size that "
		  "the features report") {
	const DeviceFixture fixture;
	const uint32_t size = fixture.device->get_features().subgroup_size;
	if (!static_cast<VulkanDevice &>(*fixture.device).subgroup_sizes.can_be_requested) {
		return;
	}
	check_request(fixture, "tests/subgroups.comp", size, /*p_has_size=*/true,
			/*p_has_full_subgroups=*/true);
	check_request(fixture, "tests/subgroups.comp", 2 * size, true, true);
	check_request(fixture, "tests/subgroups.comp", size + 1, true, /*p_has_full_subgroups=*/false);
	check_request(fixture, "tests/subgroups.comp", size / 2, true, /*p_has_full_subgroups=*/false);
	check_request(fixture, "tests/scale.comp", size, /*p_has_size=*/false, false);
}

TEST_CASE("[GPU][RenderingDevice] subgroups have the size that the features report, and are full "
		  "if the work group's size is a multiple of it") {
	DeviceFixture fixture;
	RenderingDevice &device = *fixture.device;
	const uint32_t size = device.get_features().subgroup_size;
	for (const uint32_t local_size : { size, 2 * size, size / 2 }) {
		CAPTURE(local_size);
		const uint64_t size_bytes = 2 * local_size * sizeof(uint32_t);
		const OwnedBuffer target(device,
				device.create_buffer({ .name = "target",
						.size_bytes = size_bytes,
						.usage = BufferUsage::STORAGE | BufferUsage::COPY_SOURCE }));
		const OwnedBuffer readback = fixture.make_readback(size_bytes);
		const PipelineRID pipeline = device.get_compute_pipeline({ .name = "subgroups",
				.shader = "tests/subgroups.comp",
				.constants = { { LOCAL_SIZE_ID, local_size } } });
		CommandList &commands = device.begin_commands();
		commands.bind_pipeline(pipeline);
		commands.bind_resources({ { 0, target.get() } });
		commands.dispatch({ 1, 1, 1 });
		const Barrier barrier = { .buffer = target.get(),
			.before = Access::SHADER_WRITE_COMPUTE,
			.after = Access::COPY_READ };
		commands.barriers({ &barrier, 1 });
		commands.copy_buffer(target.get(), readback.get(), size_bytes);
		device.submit_commands(RenderingDevice::SubmitMode::WAIT);
		const std::vector<uint32_t> found = fixture.read<uint32_t>(readback, 2 * local_size);
		for (uint32_t invocation = 0; invocation < local_size; ++invocation) {
			CHECK(found[2 * invocation] == size);
			CHECK(found[2 * invocation + 1] == std::min(size, local_size));
		}
	}
}

TEST_CASE("[RenderingDevice] uniform control flow is declared once, in the places that SPIR-V "
		  "requires") {
	const std::span<const uint32_t> words = find_embedded_shader("tests/subgroups.comp");
	const std::vector<uint32_t> declared = declare_uniform_control_flow(words);
	const std::vector<uint32_t> before = list_ops(words);
	const std::vector<uint32_t> after = list_ops(declared);
	REQUIRE(after.size() == before.size() + 2);
	const auto count = [](const std::vector<uint32_t> &p_ops, uint32_t p_op) {
		return std::count(p_ops.begin(), p_ops.end(), p_op);
	};
	CHECK(count(after, spv::OpExtension) == count(before, spv::OpExtension) + 1);
	CHECK(count(after, spv::OpExecutionMode) == count(before, spv::OpExecutionMode) + 1);
	// The order of section 2.4 of the SPIR-V specification.
	const auto find = [&](uint32_t p_op) { return std::find(after.begin(), after.end(), p_op); };
	const auto last_extension = std::find(after.rbegin(), after.rend(), spv::OpExtension).base();
	const auto last_mode = std::find(after.rbegin(), after.rend(), spv::OpExecutionMode).base();
	const auto last_capability = std::find(after.rbegin(), after.rend(), spv::OpCapability).base();
	CHECK(last_capability <= find(spv::OpExtension));
	CHECK(last_extension <= find(spv::OpMemoryModel));
	CHECK(find(spv::OpEntryPoint) < find(spv::OpExecutionMode));
	CHECK(last_mode <= find(spv::OpDecorate));
	CHECK(declare_uniform_control_flow(declared) == declared);
}

TEST_CASE("[SpirvReflection] shaders with subgroup operations are recognised") {
	const auto uses_subgroups = [](const char *p_name) {
		return reflect_spirv(p_name, find_embedded_shader(p_name), {}).uses_subgroups;
	};
	CHECK(uses_subgroups("tests/subgroups.comp"));
	CHECK_FALSE(uses_subgroups("tests/scale.comp"));
	CHECK_FALSE(uses_subgroups("tests/triangle.frag"));
}
