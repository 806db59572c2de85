#pragma once

#include "modules/rendering_device/resource_types.h"

#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// The bits and the order are those of Vulkan.
enum class ShaderStage : uint32_t {
	NONE = 0,
	VERTEX = 1,
	GEOMETRY = 8,
	FRAGMENT = 16,
	COMPUTE = 32
};
enum class ResourceKind : uint32_t {
	SAMPLER = 0,
	TEXTURE_WITH_SAMPLER = 1,
	TEXTURE = 2,
	STORAGE_TEXTURE = 3,
	TEXEL_BUFFER = 4,
	UNIFORM_BUFFER = 6,
	STORAGE_BUFFER = 7,
};

/// One resource of set 0.
struct ReflectedBinding {
	uint32_t binding = 0;
	ResourceKind kind = ResourceKind::SAMPLER;
	uint32_t stages = 0;	 // bits of ShaderStage
	bool is_arrayed = false; // a texture that the shader declares as an array
	bool is_used = false;	 // some function touches it; what is only declared needs no resource
};

/// What a pipeline must know of one entry point.
struct ReflectedShader {
	ShaderStage stage = ShaderStage::NONE;
	std::vector<ReflectedBinding> bindings;	 // ordered by binding
	uint32_t push_constant_bytes = 0;		 // to the end of the last member; 0 = no block
	glm::uvec3 local_size = glm::uvec3(1);	 // of compute, specialization applied
	std::vector<uint32_t> boolean_constants; // ids of specialization constants
};

/// Reads a module with one entry point `main`. A construct that the device does not support (other
/// sets, descriptor arrays, storage texel buffers) is an Error naming the shader.
ReflectedShader reflect_spirv(std::string_view p_name, std::span<const uint32_t> p_words,
		std::span<const SpecializationConstant> p_constants);

/// What a pipeline of these entry points needs, ordered by binding. Two kinds at one binding are an
/// Error naming the pipeline.
std::vector<ReflectedBinding> merge_bindings(
		const std::string &p_pipeline, std::span<const ReflectedShader> p_shaders);
/// Of all entry points together, in whole blocks of 16: C++ blocks are padded to that.
uint32_t compute_push_constant_bytes(std::span<const ReflectedShader> p_shaders);

} // namespace gnomon
