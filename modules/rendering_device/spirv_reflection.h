#pragma once

#include "modules/rendering_device/resource_types.h"

#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// Shader stages; bits and order are those of Vulkan.
enum class ShaderStage : uint32_t {
	NONE = 0,
	VERTEX = 1,
	GEOMETRY = 8,
	FRAGMENT = 16,
	COMPUTE = 32
};
/// Kinds of resources; the values are those of VkDescriptorType.
enum class ResourceKind : uint32_t {
	SAMPLER = 0,
	TEXTURE_WITH_SAMPLER = 1,
	TEXTURE = 2,
	STORAGE_TEXTURE = 3,
	TEXEL_BUFFER = 4,
	UNIFORM_BUFFER = 6,
	STORAGE_BUFFER = 7,
};

/// One binding of descriptor set 0.
struct ReflectedBinding {
	uint32_t binding = 0;
	ResourceKind kind = ResourceKind::SAMPLER;
	uint32_t stages = 0;	 // bits of ShaderStage
	bool is_arrayed = false; // a texture that the shader declares as an array
	/// Whether a function accesses it. A binding that is only declared needs no resource.
	bool is_used = false;
};

/// The interface of one entry point, as far as a pipeline needs it.
struct ReflectedShader {
	ShaderStage stage = ShaderStage::NONE;
	std::vector<ReflectedBinding> bindings;	 // ordered by binding
	uint32_t push_constant_bytes = 0;		 // to the end of the last member; 0 = no block
	glm::uvec3 local_size = glm::uvec3(1);	 // for compute, with specialization applied
	std::vector<uint32_t> boolean_constants; // constant_ids of booleans: Godot needs the type
	bool uses_subgroups = false;			 // it has subgroup operations or built-ins
};

/// Reads the interface of a SPIR-V module with one entry point `main`. A construct that the device
/// does not support (other sets, arrays of resources, storage texel buffers) is an Error
/// that names the shader. So are words that are no SPIR-V or are cut off. Other damage is not
/// always noticed and may crash: p_words must come from a compiler.
ReflectedShader reflect_spirv(std::string_view p_name, std::span<const uint32_t> p_words,
		std::span<const SpecializationConstant> p_constants);

/// Merges the bindings of a pipeline's entry points, ordered by binding. One binding with two kinds
/// of resources is an Error that names the pipeline.
std::vector<ReflectedBinding> merge_bindings(
		const std::string &p_pipeline, std::span<const ReflectedShader> p_shaders);
/// Returns the largest push-constant size of the entry points, rounded up to 16 bytes, as C++
/// blocks are padded to 16 bytes.
uint32_t compute_push_constant_bytes(std::span<const ReflectedShader> p_shaders);

} // namespace gnomon
