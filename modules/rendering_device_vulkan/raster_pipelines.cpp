#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/pipeline_stages.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

namespace {

VkPipelineColorBlendAttachmentState make_blend_state(BlendMode p_mode, Format p_format) {
	VkPipelineColorBlendAttachmentState state = { .blendEnable = p_mode != BlendMode::OFF &&
				!is_uint_format(p_format),
		.srcColorBlendFactor = VK_BLEND_FACTOR_ONE,
		.dstColorBlendFactor = VK_BLEND_FACTOR_ONE,
		.colorBlendOp = VK_BLEND_OP_ADD,
		.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
		.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE,
		.alphaBlendOp = VK_BLEND_OP_ADD,
		.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
				VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT };
	if (p_mode == BlendMode::ALPHA) {
		state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
		state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
		state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
	} else if (p_mode == BlendMode::MINIMUM) {
		state.colorBlendOp = state.alphaBlendOp = VK_BLEND_OP_MIN;
	} else if (p_mode == BlendMode::MAXIMUM) {
		state.colorBlendOp = state.alphaBlendOp = VK_BLEND_OP_MAX;
	}
	return state;
}

VkStencilOpState make_stencil_state(const StencilFace &p_face, uint32_t p_reference) {
	const uint32_t all = 0xff; // compare and write masks
	// CompareOp and StencilOp have Vulkan's order.
	return { static_cast<VkStencilOp>(p_face.fail), static_cast<VkStencilOp>(p_face.pass),
		static_cast<VkStencilOp>(p_face.depth_fail), static_cast<VkCompareOp>(p_face.compare), all,
		all, p_reference };
}

bool may_write(const StencilFace &p_face) {
	return p_face.fail != StencilOp::KEEP || p_face.depth_fail != StencilOp::KEEP ||
			p_face.pass != StencilOp::KEEP;
}

std::optional<Format> get_depth_format(const RasterPipelineDesc &p_desc) {
	if (!p_desc.has_depth) {
		return std::nullopt;
	}
	return p_desc.has_stencil ? Format::D32_SFLOAT_S8_UINT : Format::D32_SFLOAT;
}

} // namespace

void VulkanDevice::check_raster_features(const RasterPipelineDesc &p_desc) const {
	const bool has_adjacency = p_desc.topology == Topology::TRIANGLES_WITH_ADJACENCY;
	const struct {
		bool is_missing;
		const char *name;
	} NEEDS[] = {
		{ (has_adjacency || !p_desc.geometry_shader.empty()) && !features.geometry_shader,
				"geometry shaders" },
		{ p_desc.clamps_depth && !features.depth_clamp, "depth clamping" },
		{ p_desc.has_depth_bounds && !features.depth_bounds, "depth bounds" },
	};
	for (const auto &need : NEEDS) {
		if (need.is_missing) {
			fail("Pipeline '", p_desc.name, "' needs ", need.name, ", which device \"",
					physical.info.name, "\" lacks. Choose another method or another device.");
		}
	}
	for (const Format format : p_desc.color_formats) {
		VkFormatProperties properties;
		vkGetPhysicalDeviceFormatProperties(
				physical.handle, get_vulkan_format(format), &properties);
		const bool can_blend = (properties.optimalTilingFeatures &
									   VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT) != 0;
		if (p_desc.blend != BlendMode::OFF && !is_uint_format(format) && !can_blend) {
			fail("Pipeline '", p_desc.name, "' blends into ", get_format_name(format),
					", which device \"", physical.info.name,
					"\" cannot. Use a 16-bit format, or choose another device with --device.");
		}
	}
}

VkPipeline VulkanDevice::create_raster_pipeline(const RasterPipelineDesc &p_desc,
		VkPipelineLayout p_layout, std::span<const VkPipelineShaderStageCreateInfo> p_stages) {
	std::vector<VkVertexInputBindingDescription> vertex_buffers;
	for (uint32_t index = 0; index < p_desc.vertex_strides_bytes.size(); ++index) {
		vertex_buffers.push_back(
				{ index, p_desc.vertex_strides_bytes[index], VK_VERTEX_INPUT_RATE_VERTEX });
	}
	std::vector<VkVertexInputAttributeDescription> attributes;
	for (const VertexAttribute &attribute : p_desc.attributes) {
		GNOMON_ASSERT(attribute.buffer_index < vertex_buffers.size(), "pipeline '", p_desc.name,
				"': attribute ", attribute.location, " reads vertex buffer ",
				attribute.buffer_index, " of ", vertex_buffers.size());
		attributes.push_back({ attribute.location, attribute.buffer_index,
				get_attribute_format(attribute), attribute.offset_bytes });
	}
	const VkPipelineVertexInputStateCreateInfo vertex_input = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
		.vertexBindingDescriptionCount = static_cast<uint32_t>(vertex_buffers.size()),
		.pVertexBindingDescriptions = vertex_buffers.data(),
		.vertexAttributeDescriptionCount = static_cast<uint32_t>(attributes.size()),
		.pVertexAttributeDescriptions = attributes.data()
	};
	const VkPipelineInputAssemblyStateCreateInfo input_assembly = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
		.topology = p_desc.topology == Topology::TRIANGLES
				? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST
				: VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST_WITH_ADJACENCY
	};
	const VkPipelineViewportStateCreateInfo viewport = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO,
		.viewportCount = 1,
		.scissorCount = 1
	};
	const bool has_bias = p_desc.depth_bias_constant != 0.0f || p_desc.depth_bias_slope != 0.0f;
	const VkPipelineRasterizationStateCreateInfo rasterization = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
		.depthClampEnable = p_desc.clamps_depth,
		.polygonMode = VK_POLYGON_MODE_FILL,
		.cullMode = static_cast<VkCullModeFlags>(p_desc.cull_mode),
		.frontFace = p_desc.winding == Winding::NORMAL ? VK_FRONT_FACE_COUNTER_CLOCKWISE
													   : VK_FRONT_FACE_CLOCKWISE,
		.depthBiasEnable = has_bias,
		.depthBiasConstantFactor = p_desc.depth_bias_constant,
		.depthBiasSlopeFactor = p_desc.depth_bias_slope,
		.lineWidth = 1.0f
	};
	const VkPipelineMultisampleStateCreateInfo multisample = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
		.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT
	};
	const VkPipelineDepthStencilStateCreateInfo depth_stencil = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
		.depthTestEnable = p_desc.has_depth,
		.depthWriteEnable = p_desc.has_depth && p_desc.writes_depth,
		.depthCompareOp = static_cast<VkCompareOp>(p_desc.depth_compare), // same order as CompareOp
		.depthBoundsTestEnable = p_desc.has_depth_bounds,
		.stencilTestEnable = p_desc.has_stencil,
		.front = make_stencil_state(p_desc.stencil.front, p_desc.stencil.reference),
		.back = make_stencil_state(p_desc.stencil.back, p_desc.stencil.reference),
		.maxDepthBounds = 1.0f
	};
	std::vector<VkPipelineColorBlendAttachmentState> blend_states;
	std::vector<VkFormat> color_formats;
	for (const Format format : p_desc.color_formats) {
		blend_states.push_back(make_blend_state(p_desc.blend, format));
		color_formats.push_back(get_vulkan_format(format));
	}
	const VkPipelineColorBlendStateCreateInfo blend = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO,
		.attachmentCount = static_cast<uint32_t>(blend_states.size()),
		.pAttachments = blend_states.data()
	};
	const VkDynamicState dynamic_states[] = { VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
		VK_DYNAMIC_STATE_DEPTH_BOUNDS };
	const VkPipelineDynamicStateCreateInfo dynamic = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO,
		.dynamicStateCount = static_cast<uint32_t>(std::size(dynamic_states)),
		.pDynamicStates = dynamic_states
	};
	const std::optional<Format> depth_format = get_depth_format(p_desc);
	const VkFormat depth = depth_format ? get_vulkan_format(*depth_format) : VK_FORMAT_UNDEFINED;
	const VkPipelineRenderingCreateInfo targets = {
		.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
		.colorAttachmentCount = static_cast<uint32_t>(color_formats.size()),
		.pColorAttachmentFormats = color_formats.data(),
		.depthAttachmentFormat = depth,
		.stencilAttachmentFormat = p_desc.has_stencil ? depth : VK_FORMAT_UNDEFINED
	};
	const VkGraphicsPipelineCreateInfo info = {
		.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
		.pNext = &targets,
		.stageCount = static_cast<uint32_t>(p_stages.size()),
		.pStages = p_stages.data(),
		.pVertexInputState = &vertex_input,
		.pInputAssemblyState = &input_assembly,
		.pViewportState = &viewport,
		.pRasterizationState = &rasterization,
		.pMultisampleState = &multisample,
		.pDepthStencilState = &depth_stencil,
		.pColorBlendState = &blend,
		.pDynamicState = &dynamic,
		.layout = p_layout
	};
	VkPipeline pipeline = VK_NULL_HANDLE;
	compile(p_desc.name, "vkCreateGraphicsPipelines", [&] {
		return vkCreateGraphicsPipelines(device, pipeline_cache, 1, &info, nullptr, &pipeline);
	});
	return pipeline;
}

PipelineResource VulkanDevice::make_pipeline(const RasterPipelineDesc &p_desc) {
	GNOMON_ASSERT(p_desc.has_depth || !p_desc.has_stencil, "pipeline '", p_desc.name,
			"' has stencil without depth");
	GNOMON_ASSERT(p_desc.stencil.reference <= 255, "pipeline '", p_desc.name,
			"' has stencil reference ", p_desc.stencil.reference);
	check_raster_features(p_desc);
	PipelineStages stages(*this, p_desc.constants);
	stages.add(p_desc.vertex_shader, VK_SHADER_STAGE_VERTEX_BIT);
	if (!p_desc.geometry_shader.empty()) {
		stages.add(p_desc.geometry_shader, VK_SHADER_STAGE_GEOMETRY_BIT);
	}
	if (!p_desc.fragment_shader.empty()) {
		stages.add(p_desc.fragment_shader, VK_SHADER_STAGE_FRAGMENT_BIT);
	}
	PipelineResource pipeline;
	pipeline.name = p_desc.name.empty() ? p_desc.vertex_shader : p_desc.name;
	pipeline.desc = p_desc;
	pipeline.bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
	pipeline.color_formats = p_desc.color_formats;
	pipeline.depth_format = get_depth_format(p_desc);
	pipeline.writes_depth = p_desc.has_depth &&
			(p_desc.writes_depth ||
					(p_desc.has_stencil &&
							(may_write(p_desc.stencil.front) || may_write(p_desc.stencil.back))));
	pipeline.vertex_buffer_count = static_cast<uint32_t>(p_desc.vertex_strides_bytes.size());
	try {
		create_layout(pipeline, stages.get_reflected());
		pipeline.pipeline = create_raster_pipeline(p_desc, pipeline.layout, stages.get_infos());
	} catch (...) {
		destroy(pipeline);
		throw;
	}
	return pipeline;
}

PipelineRID VulkanDevice::get_raster_pipeline(const RasterPipelineDesc &p_desc) {
	fail_if_lost();
	const auto found = raster_pipelines.find(p_desc);
	if (found != raster_pipelines.end()) {
		return found->second;
	}
	return raster_pipelines[p_desc] = add_pipeline(make_pipeline(p_desc));
}

} // namespace gnomon
