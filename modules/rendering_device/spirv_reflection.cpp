#include "modules/rendering_device/spirv_reflection.h"

#include "modules/core/error.h"

#include <spirv_cross/spirv_cross.hpp>

#include <algorithm>

namespace gnomon {

namespace {

constexpr uint32_t PUSH_CONSTANT_ALIGNMENT_BYTES = 16;

/// Reads one SPIR-V module. Its functions throw spirv_cross::CompilerError if that is damaged.
class Reflector {
public:
	Reflector(std::string_view p_name, std::span<const uint32_t> p_words) :
			name(p_name), compiler(p_words.data(), p_words.size()) {}

	ReflectedShader reflect(std::span<const SpecializationConstant> p_constants) {
		shader.stage = get_stage();
		apply(p_constants);
		add_resources();
		std::stable_sort(shader.bindings.begin(), shader.bindings.end(),
				[](const auto &p_left, const auto &p_right) {
					return p_left.binding < p_right.binding;
				});
		for (const spv::Capability capability : compiler.get_declared_capabilities()) {
			shader.uses_subgroups = shader.uses_subgroups ||
					(capability >= spv::CapabilityGroupNonUniform &&
							capability <= spv::CapabilityGroupNonUniformQuad);
		}
		if (shader.stage == ShaderStage::COMPUTE) {
			set_local_size();
		}
		return shader;
	}

private:
	ShaderStage get_stage() const {
		switch (const spv::ExecutionModel model = compiler.get_execution_model()) {
			case spv::ExecutionModelVertex:
				return ShaderStage::VERTEX;
			case spv::ExecutionModelGeometry:
				return ShaderStage::GEOMETRY;
			case spv::ExecutionModelFragment:
				return ShaderStage::FRAGMENT;
			case spv::ExecutionModelGLCompute:
				return ShaderStage::COMPUTE;
			default:
				fail("Shader \"", name, "\" has execution model ", model,
						"; vertex, geometry, fragment and compute are supported.");
		}
	}

	/// Gives the specialization constants their values, and lists the boolean ones.
	void apply(std::span<const SpecializationConstant> p_constants) {
		for (const auto &[id, constant_id] : compiler.get_specialization_constants()) {
			spirv_cross::SPIRConstant &constant = compiler.get_constant(id);
			if (compiler.get_type(constant.constant_type).basetype == Type::Boolean) {
				shader.boolean_constants.push_back(constant_id);
			}
			for (const SpecializationConstant &value : p_constants) {
				if (value.constant_id == constant_id) {
					constant.m.c[0].r[0].u32 = value.value;
				}
			}
		}
	}

	void add_resources() {
		const spirv_cross::ShaderResources found = compiler.get_shader_resources();
		const auto used = compiler.get_active_interface_variables();
		const auto add = [&](const auto &p_resources, ResourceKind p_kind) {
			for (const spirv_cross::Resource &resource : p_resources) {
				add_binding(resource, p_kind, used.contains(resource.id));
			}
		};
		add(found.uniform_buffers, ResourceKind::UNIFORM_BUFFER);
		add(found.storage_buffers, ResourceKind::STORAGE_BUFFER);
		add(found.storage_images, ResourceKind::STORAGE_TEXTURE);
		add(found.sampled_images, ResourceKind::TEXTURE_WITH_SAMPLER);
		add(found.separate_images, ResourceKind::TEXTURE);
		add(found.separate_samplers, ResourceKind::SAMPLER);
		for (const auto *others : { &found.subpass_inputs, &found.acceleration_structures }) {
			if (!others->empty()) {
				fail("Shader \"", name, "\": binding ", get_binding(others->front()),
						" is neither a buffer nor a texture or sampler. Use one of these.");
			}
		}
		for (const spirv_cross::Resource &block : found.push_constant_buffers) {
			shader.push_constant_bytes = static_cast<uint32_t>(
					compiler.get_declared_struct_size(compiler.get_type(block.base_type_id)));
		}
	}

	uint32_t get_binding(const spirv_cross::Resource &p_resource) const {
		return compiler.get_decoration(p_resource.id, spv::DecorationBinding);
	}

	void add_binding(const spirv_cross::Resource &p_resource, ResourceKind p_kind, bool p_is_used) {
		const uint32_t number = get_binding(p_resource);
		const uint32_t set = compiler.get_decoration(p_resource.id, spv::DecorationDescriptorSet);
		if (set != 0) {
			fail("Shader \"", name, "\": binding ", number, " is in set ", set,
					"; only set 0 is used. Change its layout.");
		}
		const Type &type = compiler.get_type(p_resource.type_id);
		if (!type.array.empty()) {
			fail("Shader \"", name, "\": binding ", number,
					" is an array of resources, which is not supported. Use one binding for each.");
		}
		const bool is_texture = type.basetype == Type::Image || type.basetype == Type::SampledImage;
		const bool is_texel_buffer = is_texture && type.image.dim == spv::DimBuffer;
		if (is_texel_buffer && p_kind == ResourceKind::STORAGE_TEXTURE) {
			fail("Shader \"", name, "\": binding ", number,
					" is a storage texel buffer, which is not supported. Use a storage buffer.");
		}
		shader.bindings.push_back({ .binding = number,
				.kind = is_texel_buffer ? ResourceKind::TEXEL_BUFFER : p_kind,
				.stages = static_cast<uint32_t>(shader.stage),
				.is_arrayed = is_texture && type.image.arrayed,
				.is_used = p_is_used });
	}

	void set_local_size() {
		spirv_cross::SpecializationConstant sizes[3];
		// A constant decorated WorkgroupSize has precedence over the execution mode.
		const uint32_t all =
				compiler.get_work_group_size_specialization_constants(sizes[0], sizes[1], sizes[2]);
		for (uint32_t axis = 0; axis < 3; ++axis) {
			const uint32_t id = sizes[axis].id;
			shader.local_size[glm::length_t(axis)] = id != 0 ? compiler.get_constant(id).scalar()
					: all != 0
					? compiler.get_constant(all).scalar(0, axis)
					: compiler.get_execution_mode_argument(spv::ExecutionModeLocalSize, axis);
		}
	}

	using Type = spirv_cross::SPIRType;

	std::string_view name;
	spirv_cross::Compiler compiler;
	ReflectedShader shader;
};

} // namespace

ReflectedShader reflect_spirv(std::string_view p_name, std::span<const uint32_t> p_words,
		std::span<const SpecializationConstant> p_constants) {
	try {
		return Reflector(p_name, p_words).reflect(p_constants);
	} catch (const spirv_cross::CompilerError &error) {
		fail("Shader \"", p_name, "\" cannot be read as SPIR-V: ", error.what(),
				" Build it again.");
	}
}

std::vector<ReflectedBinding> merge_bindings(
		const std::string &p_pipeline, std::span<const ReflectedShader> p_shaders) {
	std::vector<ReflectedBinding> merged;
	for (const ReflectedShader &shader : p_shaders) {
		for (const ReflectedBinding &binding : shader.bindings) {
			const auto found = std::find_if(
					merged.begin(), merged.end(), [&](const ReflectedBinding &p_other) {
						return p_other.binding == binding.binding;
					});
			if (found == merged.end()) {
				merged.push_back(binding);
				continue;
			}
			if (found->kind != binding.kind || found->is_arrayed != binding.is_arrayed) {
				fail("Pipeline '", p_pipeline, "': binding ", binding.binding,
						" is declared as two kinds of resource, or as a texture and as an array. "
						"Give one of them another number.");
			}
			if (binding.is_used) { // stages that only declare it are dropped
				found->stages = found->is_used ? found->stages | binding.stages : binding.stages;
				found->is_used = true;
			}
		}
	}
	std::sort(merged.begin(), merged.end(), [](const auto &p_left, const auto &p_right) {
		return p_left.binding < p_right.binding;
	});
	return merged;
}

uint32_t compute_push_constant_bytes(std::span<const ReflectedShader> p_shaders) {
	uint32_t bytes = 0;
	for (const ReflectedShader &shader : p_shaders) {
		bytes = std::max(bytes, shader.push_constant_bytes);
	}
	return (bytes + PUSH_CONSTANT_ALIGNMENT_BYTES - 1) / PUSH_CONSTANT_ALIGNMENT_BYTES *
			PUSH_CONSTANT_ALIGNMENT_BYTES;
}

} // namespace gnomon
