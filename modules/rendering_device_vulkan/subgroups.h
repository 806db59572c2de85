#pragma once

#include "modules/rendering_device/spirv_reflection.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <span>
#include <vector>

namespace gnomon {

/// The sizes of subgroups with which a device can run compute shaders. Powers of two.
struct SubgroupSizes {
	uint32_t usual = 0; // without a request. Intel and AMD may choose other sizes nevertheless
	uint32_t min = 0;
	uint32_t max = 0;
	bool can_be_requested = false;
};
SubgroupSizes find_subgroup_sizes(VkPhysicalDevice p_device);

/// Returns the size that compute shaders with subgroup operations request: 32 if the device allows
/// it, else the allowed size next to it; the usual size if it cannot be requested.
uint32_t choose_subgroup_size(const SubgroupSizes &p_sizes);

/// What a compute stage requests of its subgroups. Must live as long as the stage's create info.
class SubgroupRequest {
public:
	explicit SubgroupRequest(const SubgroupSizes &p_sizes);
	/// Requests the chosen size, and full subgroups if work groups can be divided into such. Does
	/// nothing for a shader without subgroup operations.
	void add_to(VkPipelineShaderStageCreateInfo &r_info, const ReflectedShader &p_shader) const;

private:
	VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO
	};
	bool can_be_requested = false;
};

/// Returns the SPIR-V with SPV_KHR_subgroup_uniform_control_flow declared: subgroups whose
/// invocations take a branch together are together behind it too. Needs the device feature
/// shaderSubgroupUniformControlFlow. SPIR-V that declares it is returned as it is.
std::vector<uint32_t> declare_uniform_control_flow(std::span<const uint32_t> p_words);

} // namespace gnomon
