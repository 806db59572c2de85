#include "modules/rendering_device/spirv_reflection.h"

#include "modules/core/error.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <map>
#include <optional>

namespace gnomon {

namespace {

constexpr uint32_t PUSH_CONSTANT_ALIGNMENT_BYTES = 16;
constexpr size_t SPIRV_HEADER_WORDS = 5;
constexpr uint32_t IMAGE_IS_STORAGE = 2; // operand "Sampled" of OpTypeImage

using Instruction = std::span<const uint32_t>; // word 0: opcode and length in words

/// Reads one SPIR-V module.
class Reflector {
public:
	Reflector(std::string_view p_name, std::span<const SpecializationConstant> p_constants) :
			name(p_name), constants(p_constants) {}

	ReflectedShader reflect(std::span<const uint32_t> p_words) {
		read(p_words);
		ReflectedShader shader;
		shader.stage = stage;
		for (const auto &[id, variable] : variables) {
			add_variable(id, variable, shader);
		}
		std::sort(shader.bindings.begin(), shader.bindings.end(),
				[](const auto &p_left, const auto &p_right) {
					return p_left.binding < p_right.binding;
				});
		shader.local_size = compute_local_size();
		shader.uses_subgroups = uses_subgroups;
		for (const uint32_t id : booleans) {
			shader.boolean_constants.push_back(find_decoration(id, spv::DecorationSpecId).value());
		}
		return shader;
	}

private:
	struct Variable {
		uint32_t pointer_type = 0;
		uint32_t storage_class = 0;
		bool is_used = false;
	};

	void read(std::span<const uint32_t> p_words) {
		if (p_words.size() < SPIRV_HEADER_WORDS || p_words[0] != spv::MagicNumber) {
			fail("Shader \"", name, "\" holds no SPIR-V. Build it again.");
		}
		bool is_in_function = false;
		for (size_t at = SPIRV_HEADER_WORDS; at < p_words.size();) {
			const uint32_t length = p_words[at] >> 16;
			if (length == 0 || at + length > p_words.size()) {
				fail("Shader \"", name, "\" is damaged at word ", at, ". Build it again.");
			}
			const Instruction instruction = p_words.subspan(at, length);
			is_in_function = is_in_function || get_op(instruction) == spv::OpFunction;
			if (is_in_function) {
				mark_used(instruction);
			} else {
				read_declaration(instruction);
			}
			at += length;
		}
	}

	static uint32_t get_op(Instruction p_instruction) { return p_instruction[0] & 0xffffu; }

	void read_declaration(Instruction p_in) {
		const uint32_t op = get_op(p_in);
		switch (op) {
			case spv::OpCapability:
				uses_subgroups = uses_subgroups ||
						(p_in[1] >= spv::CapabilityGroupNonUniform &&
								p_in[1] <= spv::CapabilityGroupNonUniformQuad);
				break;
			case spv::OpEntryPoint:
				stage = get_stage(p_in[1]);
				break;
			case spv::OpExecutionMode:
			case spv::OpExecutionModeId:
				if (p_in[2] == spv::ExecutionModeLocalSize) {
					local_size = glm::uvec3(p_in[3], p_in[4], p_in[5]);
				} else if (p_in[2] == spv::ExecutionModeLocalSizeId) {
					local_size_ids = glm::uvec3(p_in[3], p_in[4], p_in[5]);
				}
				break;
			case spv::OpDecorate:
				decorations[{ p_in[1], p_in[2] }] = p_in.size() > 3 ? p_in[3] : 0;
				break;
			case spv::OpMemberDecorate:
				member_decorations[{ p_in[1], p_in[2], p_in[3] }] = p_in.size() > 4 ? p_in[4] : 0;
				break;
			case spv::OpSpecConstantTrue:
			case spv::OpSpecConstantFalse:
				booleans.push_back(p_in[2]);
				break;
			case spv::OpVariable:
				variables[p_in[2]] = { p_in[1], p_in[3], false };
				break;
			default: // types by id, and constants, where the id follows their type
				if (op >= spv::OpTypeVoid && op <= spv::OpTypePipe) {
					definitions[p_in[1]] = p_in;
				} else if (op >= spv::OpConstantTrue && op <= spv::OpSpecConstantOp) {
					definitions[p_in[2]] = p_in;
				}
				break;
		}
	}

	/// Marks the variables that an instruction accesses. Checks only operands that are pointers,
	/// because a literal in another operand could equal an id.
	void mark_used(Instruction p_in) {
		switch (get_op(p_in)) {
			case spv::OpLoad:
			case spv::OpAccessChain:
			case spv::OpInBoundsAccessChain:
			case spv::OpPtrAccessChain:
			case spv::OpArrayLength:
			case spv::OpImageTexelPointer:
			case spv::OpCopyObject:
				mark_variable(p_in[3]);
				break;
			case spv::OpStore:
				mark_variable(p_in[1]);
				break;
			case spv::OpCopyMemory:
				mark_variable(p_in[1]);
				mark_variable(p_in[2]);
				break;
			case spv::OpFunctionCall:
				for (const uint32_t argument : p_in.subspan(4)) {
					mark_variable(argument);
				}
				break;
			default:
				break;
		}
	}

	void mark_variable(uint32_t p_id) {
		if (const auto found = variables.find(p_id); found != variables.end()) {
			found->second.is_used = true;
		}
	}

	ShaderStage get_stage(uint32_t p_model) const {
		switch (p_model) {
			case spv::ExecutionModelVertex:
				return ShaderStage::VERTEX;
			case spv::ExecutionModelGeometry:
				return ShaderStage::GEOMETRY;
			case spv::ExecutionModelFragment:
				return ShaderStage::FRAGMENT;
			case spv::ExecutionModelGLCompute:
				return ShaderStage::COMPUTE;
			default:
				fail("Shader \"", name, "\" has execution model ", p_model,
						"; vertex, geometry, fragment and compute are supported.");
		}
	}

	std::optional<uint32_t> find_decoration(uint32_t p_id, uint32_t p_decoration) const {
		const auto found = decorations.find({ p_id, p_decoration });
		return found == decorations.end() ? std::nullopt : std::optional(found->second);
	}

	uint32_t get_member_decoration(
			uint32_t p_type, uint32_t p_member, uint32_t p_decoration) const {
		const auto found = member_decorations.find({ p_type, p_member, p_decoration });
		return found == member_decorations.end() ? 0 : found->second;
	}

	Instruction get_definition(uint32_t p_id) const {
		const auto found = definitions.find(p_id);
		GNOMON_ASSERT(found != definitions.end(), "shader ", name, ": id ", p_id);
		return found->second;
	}

	/// Returns the value of an integer constant, with specialization applied.
	uint32_t get_constant(uint32_t p_id) const {
		if (const auto spec_id = find_decoration(p_id, spv::DecorationSpecId)) {
			for (const SpecializationConstant &constant : constants) {
				if (constant.constant_id == *spec_id) {
					return constant.value;
				}
			}
		}
		return get_definition(p_id)[3];
	}

	void add_variable(uint32_t p_id, const Variable &p_variable, ReflectedShader &r_shader) const {
		const uint32_t type = get_definition(p_variable.pointer_type)[3];
		if (p_variable.storage_class == spv::StorageClassPushConstant) {
			r_shader.push_constant_bytes = compute_size_bytes(type, 0);
			return;
		}
		if (p_variable.storage_class != spv::StorageClassUniformConstant &&
				p_variable.storage_class != spv::StorageClassUniform &&
				p_variable.storage_class != spv::StorageClassStorageBuffer) {
			return;
		}
		const uint32_t set = find_decoration(p_id, spv::DecorationDescriptorSet).value_or(0);
		ReflectedBinding binding;
		binding.binding = find_decoration(p_id, spv::DecorationBinding).value_or(0);
		binding.stages = static_cast<uint32_t>(stage);
		binding.is_used = p_variable.is_used;
		if (set != 0) {
			fail("Shader \"", name, "\": binding ", binding.binding, " is in set ", set,
					"; only set 0 is used. Change its layout.");
		}
		set_kind(type, p_variable.storage_class, binding);
		r_shader.bindings.push_back(binding);
	}

	void set_kind(uint32_t p_type, uint32_t p_storage_class, ReflectedBinding &r_binding) const {
		Instruction type = get_definition(p_type);
		if (get_op(type) == spv::OpTypeArray || get_op(type) == spv::OpTypeRuntimeArray) {
			fail("Shader \"", name, "\": binding ", r_binding.binding,
					" is an array of resources, which is not supported. Use one binding for each.");
		}
		if (p_storage_class == spv::StorageClassStorageBuffer) {
			r_binding.kind = ResourceKind::STORAGE_BUFFER;
			return;
		}
		if (p_storage_class == spv::StorageClassUniform) {
			r_binding.kind = find_decoration(p_type, spv::DecorationBufferBlock)
					? ResourceKind::STORAGE_BUFFER
					: ResourceKind::UNIFORM_BUFFER;
			return;
		}
		const bool is_combined = get_op(type) == spv::OpTypeSampledImage;
		if (is_combined) {
			type = get_definition(type[2]);
		}
		if (get_op(type) == spv::OpTypeSampler) {
			r_binding.kind = ResourceKind::SAMPLER;
			return;
		}
		if (get_op(type) != spv::OpTypeImage) {
			fail("Shader \"", name, "\": binding ", r_binding.binding,
					" is neither a buffer nor a texture or sampler. Use one of these.");
		}
		// Operands of OpTypeImage: word 3 is Dim, 5 Arrayed, 7 Sampled.
		const bool is_buffer = type[3] == spv::DimBuffer;
		const bool is_storage = type[7] == IMAGE_IS_STORAGE;
		r_binding.is_arrayed = type[5] == 1;
		if (is_buffer && is_storage) {
			fail("Shader \"", name, "\": binding ", r_binding.binding,
					" is a storage texel buffer, which is not supported. Use a storage buffer.");
		}
		if (is_buffer) {
			r_binding.kind = ResourceKind::TEXEL_BUFFER;
		} else if (is_storage) {
			r_binding.kind = ResourceKind::STORAGE_TEXTURE;
		} else {
			r_binding.kind =
					is_combined ? ResourceKind::TEXTURE_WITH_SAMPLER : ResourceKind::TEXTURE;
		}
	}

	/// p_matrix_stride_bytes: stride of the struct member of this type, if it is a matrix.
	uint32_t compute_size_bytes(uint32_t p_type, uint32_t p_matrix_stride_bytes) const {
		const Instruction type = get_definition(p_type);
		switch (get_op(type)) {
			case spv::OpTypeInt:
			case spv::OpTypeFloat:
				return type[2] / 8;
			case spv::OpTypeVector:
				return type[3] * compute_size_bytes(type[2], 0);
			case spv::OpTypeMatrix:
				return type[3] * p_matrix_stride_bytes;
			case spv::OpTypeArray:
				return get_constant(type[3]) *
						find_decoration(p_type, spv::DecorationArrayStride).value_or(0);
			case spv::OpTypeStruct: {
				uint32_t end = 0;
				for (uint32_t member = 0; member + 2 < type.size(); ++member) {
					const uint32_t offset =
							get_member_decoration(p_type, member, spv::DecorationOffset);
					const uint32_t stride =
							get_member_decoration(p_type, member, spv::DecorationMatrixStride);
					end = std::max(end, offset + compute_size_bytes(type[member + 2], stride));
				}
				return end;
			}
			default:
				fail("Shader \"", name, "\": a push constant has an unsupported type. Use floats, ",
						"integers, vectors, matrices, arrays and structures.");
		}
	}

	glm::uvec3 compute_local_size() const {
		// A constant decorated WorkgroupSize has precedence over the execution modes.
		for (const auto &[key, value] : decorations) {
			if (key.second == spv::DecorationBuiltIn && value == spv::BuiltInWorkgroupSize) {
				const Instruction sizes = get_definition(key.first);
				return { get_constant(sizes[3]), get_constant(sizes[4]), get_constant(sizes[5]) };
			}
		}
		if (local_size_ids) {
			return { get_constant(local_size_ids->x), get_constant(local_size_ids->y),
				get_constant(local_size_ids->z) };
		}
		return local_size;
	}

	std::string_view name;
	std::span<const SpecializationConstant> constants;
	ShaderStage stage = ShaderStage::NONE;
	bool uses_subgroups = false;
	glm::uvec3 local_size = glm::uvec3(1);
	std::optional<glm::uvec3> local_size_ids;
	std::map<std::pair<uint32_t, uint32_t>, uint32_t> decorations;	// id, decoration -> operand
	std::map<std::array<uint32_t, 3>, uint32_t> member_decorations; // type, member, decoration
	std::map<uint32_t, Instruction> definitions;					// types and constants
	std::map<uint32_t, Variable> variables;
	std::vector<uint32_t> booleans; // result ids of boolean specialization constants
};

} // namespace

ReflectedShader reflect_spirv(std::string_view p_name, std::span<const uint32_t> p_words,
		std::span<const SpecializationConstant> p_constants) {
	return Reflector(p_name, p_constants).reflect(p_words);
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
