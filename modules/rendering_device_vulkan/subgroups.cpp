// SPIR-V: no pass of SPIRV-Tools adds an extension or an execution mode; SPIRV-Cross only reads.
#include "modules/rendering_device_vulkan/subgroups.h"

#include <spirv_cross/spirv.hpp>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string_view>

namespace gnomon {

namespace {

// Warps of NVIDIA, and allowed by Intel and AMD since RDNA. With 64 lanes, half of a subgroup would
// idle in groups of 32 and less.
constexpr uint32_t PREFERRED_SIZE = 32;
constexpr size_t SPIRV_HEADER_WORDS = 5;
constexpr std::string_view UNIFORM_CONTROL_FLOW = "SPV_KHR_subgroup_uniform_control_flow";

uint32_t make_first_word(spv::Op p_op, size_t p_length) {
	return static_cast<uint32_t>(p_length << 16 | p_op);
}

} // namespace

SubgroupSizes find_subgroup_sizes(VkPhysicalDevice p_device) {
	VkPhysicalDeviceVulkan13Features features13 = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES
	};
	VkPhysicalDeviceFeatures2 features = { .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
		.pNext = &features13 };
	vkGetPhysicalDeviceFeatures2(p_device, &features);
	VkPhysicalDeviceSubgroupSizeControlProperties control = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES
	};
	VkPhysicalDeviceSubgroupProperties subgroup = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, .pNext = &control
	};
	VkPhysicalDeviceProperties2 properties = {
		.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup
	};
	vkGetPhysicalDeviceProperties2(p_device, &properties);
	return { .usual = subgroup.subgroupSize,
		.min = control.minSubgroupSize,
		.max = control.maxSubgroupSize,
		.can_be_requested = features13.subgroupSizeControl && features13.computeFullSubgroups &&
				(control.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 };
}

uint32_t choose_subgroup_size(const SubgroupSizes &p_sizes) {
	return p_sizes.can_be_requested ? std::clamp(PREFERRED_SIZE, p_sizes.min, p_sizes.max)
									: p_sizes.usual;
}

SubgroupRequest::SubgroupRequest(const SubgroupSizes &p_sizes) :
		can_be_requested(p_sizes.can_be_requested) {
	size.requiredSubgroupSize = choose_subgroup_size(p_sizes);
}

void SubgroupRequest::add_to(
		VkPipelineShaderStageCreateInfo &r_info, const ReflectedShader &p_shader) const {
	if (!can_be_requested || !p_shader.uses_subgroups || p_shader.stage != ShaderStage::COMPUTE) {
		return;
	}
	r_info.pNext = &size;
	if (p_shader.local_size.x % size.requiredSubgroupSize == 0) {
		r_info.flags |= VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
	}
}

std::vector<uint32_t> declare_uniform_control_flow(std::span<const uint32_t> p_words) {
	std::optional<size_t> extensions_end; // behind the capabilities and the extensions
	std::optional<size_t> modes_end;	  // behind the entry point and its execution modes
	uint32_t entry_point = 0;
	for (size_t at = SPIRV_HEADER_WORDS; at < p_words.size(); at += p_words[at] >> 16) {
		const uint32_t op = p_words[at] & 0xffffu;
		const size_t end = at + (p_words[at] >> 16);
		if (op == spv::OpCapability || op == spv::OpExtension) {
			extensions_end = end;
		} else if (op == spv::OpEntryPoint) {
			entry_point = p_words[at + 2];
			modes_end = end;
		} else if (op == spv::OpExecutionMode || op == spv::OpExecutionModeId) {
			modes_end = end;
			if (p_words[at + 2] == spv::ExecutionModeSubgroupUniformControlFlowKHR) {
				return { p_words.begin(), p_words.end() };
			}
		} else if (op == spv::OpFunction) {
			break;
		}
	}
	std::vector<uint32_t> words(p_words.begin(), p_words.end());
	const uint32_t mode[] = { make_first_word(spv::OpExecutionMode, 3), entry_point,
		spv::ExecutionModeSubgroupUniformControlFlowKHR };
	words.insert(words.begin() + static_cast<ptrdiff_t>(modes_end.value()), std::begin(mode),
			std::end(mode));
	// One word more for the first, and the text with at least one zero at its end.
	std::vector<uint32_t> extension(1 + UNIFORM_CONTROL_FLOW.size() / sizeof(uint32_t) + 1);
	extension[0] = make_first_word(spv::OpExtension, extension.size());
	std::memcpy(&extension[1], UNIFORM_CONTROL_FLOW.data(), UNIFORM_CONTROL_FLOW.size());
	words.insert(words.begin() + static_cast<ptrdiff_t>(extensions_end.value()), extension.begin(),
			extension.end());
	return words;
}

} // namespace gnomon
