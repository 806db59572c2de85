#pragma once

#include "modules/rendering_device/resource_types.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// One descriptor of set 0.
struct ReflectedBinding {
	uint32_t binding = 0;
	VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
	VkShaderStageFlags stages = 0;
	bool is_arrayed = false; // a texture that the shader declares as an array
	bool is_used = false;	 // some function touches it; what is only declared needs no resource
};

/// What a pipeline must know of one entry point.
struct ReflectedShader {
	VkShaderStageFlagBits stage = VK_SHADER_STAGE_FLAG_BITS_MAX_ENUM;
	std::vector<ReflectedBinding> bindings; // ordered by binding
	uint32_t push_constant_bytes = 0;		// to the end of the last member; 0 = no block
	glm::uvec3 local_size = glm::uvec3(1);	// of compute, specialization applied
};

/// Reads a module with one entry point `main`. A construct that the device does not support (other
/// sets, descriptor arrays, storage texel buffers) is an Error naming the shader.
ReflectedShader reflect_spirv(std::string_view p_name, std::span<const uint32_t> p_words,
		std::span<const SpecializationConstant> p_constants);

} // namespace gnomon
