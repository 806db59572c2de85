#pragma once

#include "modules/rendering_device_vulkan/vulkan_device.h"

namespace gnomon {

/// The entry points of a pipeline with everything that its create info points to. The shader
/// modules live as long as this object.
class PipelineStages {
public:
	PipelineStages(VulkanDevice &r_device, const std::vector<SpecializationConstant> &p_constants);
	~PipelineStages();
	PipelineStages(const PipelineStages &) = delete;
	PipelineStages &operator=(const PipelineStages &) = delete;

	/// A compute shader with subgroup operations requests subgroups of the size in DeviceFeatures.
	/// An unknown shader is an Error; a shader of another stage is a programming error.
	void add(const std::string &p_shader, VkShaderStageFlagBits p_expected_stage);
	const std::vector<ReflectedShader> &get_reflected() const { return reflected; }
	const std::vector<VkPipelineShaderStageCreateInfo> &get_infos() const { return infos; }

private:
	VulkanDevice &device;
	const std::vector<SpecializationConstant> &constants;
	// Of all stages together: Vulkan ignores constants that a shader lacks.
	std::vector<VkSpecializationMapEntry> entries;
	std::vector<uint32_t> values;
	VkSpecializationInfo specialization = {};
	SubgroupRequest subgroup_request; // the infos point to it
	std::vector<ReflectedShader> reflected;
	std::vector<VkPipelineShaderStageCreateInfo> infos;
};

} // namespace gnomon
