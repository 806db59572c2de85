#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/compilation_watch.h"
#include "modules/rendering_device_vulkan/pipeline_stages.h"

namespace gnomon {

void VulkanDevice::create_layout(
		PipelineResource &r_pipeline, std::span<const ReflectedShader> p_shaders) {
	r_pipeline.bindings = merge_bindings(r_pipeline.name, p_shaders);
	r_pipeline.push_constant_bytes = compute_push_constant_bytes(p_shaders);
	for (const ReflectedShader &shader : p_shaders) {
		if (shader.push_constant_bytes > 0) {
			r_pipeline.push_constant_stages |= static_cast<VkShaderStageFlags>(shader.stage);
		}
	}
	if (r_pipeline.push_constant_bytes > limits.maxPushConstantsSize) {
		fail("Pipeline '", r_pipeline.name, "' has ", r_pipeline.push_constant_bytes,
				" bytes of push constants; device \"", physical.info.name, "\" has at most ",
				limits.maxPushConstantsSize, ". Move some into a uniform buffer.");
	}
	std::vector<VkDescriptorSetLayoutBinding> bindings;
	for (const ReflectedBinding &binding : r_pipeline.bindings) {
		if (binding.is_used) {
			bindings.push_back({ .binding = binding.binding,
					.descriptorType = static_cast<VkDescriptorType>(binding.kind),
					.descriptorCount = 1,
					.stageFlags = binding.stages });
		}
	}
	r_pipeline.uses_resources = !bindings.empty();
	const VkDescriptorSetLayoutCreateInfo set_info = {
		.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
		.bindingCount = static_cast<uint32_t>(bindings.size()),
		.pBindings = bindings.data()
	};
	check(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &r_pipeline.set_layout),
			"vkCreateDescriptorSetLayout");
	set_name(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, r_pipeline.set_layout, r_pipeline.name);
	const VkPushConstantRange range = { r_pipeline.push_constant_stages, 0,
		r_pipeline.push_constant_bytes };
	const VkPipelineLayoutCreateInfo info = { .sType =
													  VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
		.setLayoutCount = 1,
		.pSetLayouts = &r_pipeline.set_layout,
		.pushConstantRangeCount = r_pipeline.push_constant_bytes > 0 ? 1u : 0u,
		.pPushConstantRanges = &range };
	check(vkCreatePipelineLayout(device, &info, nullptr, &r_pipeline.layout),
			"vkCreatePipelineLayout");
	set_name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, r_pipeline.layout, r_pipeline.name);
}

void VulkanDevice::destroy(PipelineResource &r_pipeline) {
	vkDestroyPipeline(device, r_pipeline.pipeline, nullptr);
	vkDestroyPipelineLayout(device, r_pipeline.layout, nullptr);
	vkDestroyDescriptorSetLayout(device, r_pipeline.set_layout, nullptr);
}

PipelineRID VulkanDevice::add_pipeline(PipelineResource &&p_pipeline) {
	set_name(VK_OBJECT_TYPE_PIPELINE, p_pipeline.pipeline, p_pipeline.name);
	pipelines.push_back(std::move(p_pipeline));
	return { pipelines.size() };
}

const PipelineResource &VulkanDevice::get_pipeline(PipelineRID p_pipeline) const {
	GNOMON_ASSERT(p_pipeline.id >= 1 && p_pipeline.id <= pipelines.size(), "pipeline handle ",
			p_pipeline.id);
	return pipelines[p_pipeline.id - 1];
}

void VulkanDevice::compile(const std::string &p_pipeline, const char *p_call,
		const std::function<VkResult()> &p_compile) {
	CompilationWatch watch(p_pipeline, wait_limit_s);
	if (injected_fault.fault == Fault::SLOW_COMPILATION &&
			injected_fault.find_pass({ p_pipeline })) {
		injected_fault = {};
		watch.wait_for_warning();
	}
	check(p_compile(), text(p_call, " of '", p_pipeline, "'").c_str());
}

PipelineResource VulkanDevice::make_pipeline(const ComputePipelineDesc &p_desc) {
	PipelineStages stages(*this, p_desc.constants);
	stages.add(p_desc.shader, VK_SHADER_STAGE_COMPUTE_BIT);
	PipelineResource pipeline;
	pipeline.name = p_desc.name.empty() ? p_desc.shader : p_desc.name;
	pipeline.desc = p_desc;
	pipeline.bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
	pipeline.local_size = stages.get_reflected()[0].local_size;
	try {
		create_layout(pipeline, stages.get_reflected());
		const VkComputePipelineCreateInfo info = {
			.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
			.stage = stages.get_infos()[0],
			.layout = pipeline.layout
		};
		compile(pipeline.name, "vkCreateComputePipelines", [&] {
			return vkCreateComputePipelines(
					device, pipeline_cache, 1, &info, nullptr, &pipeline.pipeline);
		});
	} catch (...) {
		destroy(pipeline);
		throw;
	}
	return pipeline;
}

PipelineRID VulkanDevice::get_compute_pipeline(const ComputePipelineDesc &p_desc) {
	fail_if_lost();
	const auto found = compute_pipelines.find(p_desc);
	if (found != compute_pipelines.end()) {
		return found->second;
	}
	return compute_pipelines[p_desc] = add_pipeline(make_pipeline(p_desc));
}

} // namespace gnomon
