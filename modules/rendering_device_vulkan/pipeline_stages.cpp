#include "modules/rendering_device_vulkan/pipeline_stages.h"

#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"

namespace gnomon {

PipelineStages::PipelineStages(
		VulkanDevice &r_device, const std::vector<SpecializationConstant> &p_constants) :
		device(r_device),
		constants(p_constants), subgroup_request(r_device.subgroup_sizes) {
	for (const SpecializationConstant &constant : p_constants) {
		entries.push_back({ constant.constant_id,
				static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t) });
		values.push_back(constant.value);
	}
	specialization = { static_cast<uint32_t>(entries.size()), entries.data(),
		values.size() * sizeof(uint32_t), values.data() };
}

PipelineStages::~PipelineStages() {
	for (const VkPipelineShaderStageCreateInfo &info : infos) {
		vkDestroyShaderModule(device.device, info.module, nullptr);
	}
}

void PipelineStages::add(const std::string &p_shader, VkShaderStageFlagBits p_expected_stage) {
	std::span<const uint32_t> words = find_embedded_shader(p_shader);
	reflected.push_back(reflect_spirv(p_shader, words, constants));
	const auto stage = static_cast<VkShaderStageFlagBits>(reflected.back().stage);
	GNOMON_ASSERT(stage == p_expected_stage, "shader ", p_shader, " is of stage ", stage,
			", expected ", p_expected_stage);
	std::vector<uint32_t> declared_words;
	if (device.has_uniform_control_flow && reflected.back().uses_subgroups) {
		declared_words = declare_uniform_control_flow(words);
		words = declared_words;
	}
	const VkShaderModuleCreateInfo module_info = {
		.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
		.codeSize = words.size_bytes(),
		.pCode = words.data()
	};
	VkShaderModule module = VK_NULL_HANDLE;
	device.check(vkCreateShaderModule(device.device, &module_info, nullptr, &module),
			"vkCreateShaderModule");
	device.set_name(VK_OBJECT_TYPE_SHADER_MODULE, module, p_shader);
	infos.push_back({ .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
			.stage = p_expected_stage,
			.module = module,
			.pName = "main",
			.pSpecializationInfo = &specialization });
	subgroup_request.add_to(infos.back(), reflected.back());
}

} // namespace gnomon
