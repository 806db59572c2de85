#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/access.h"
#include "modules/rendering_device_vulkan/spirv_reflection.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

ReflectedShader reflect(
		std::string_view p_name, const std::vector<SpecializationConstant> &p_constants = {}) {
	return reflect_spirv(p_name, find_embedded_shader(p_name), p_constants);
}

} // namespace

TEST_CASE("[SpirvReflection] each kind of resource is recognised") {
	const ReflectedShader shader = reflect("tests/bindings.comp");
	const VkDescriptorType types[] = { VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
		VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
		VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLER,
		VK_DESCRIPTOR_TYPE_STORAGE_IMAGE };
	REQUIRE(shader.bindings.size() == std::size(types));
	for (uint32_t index = 0; index < std::size(types); ++index) {
		CHECK(shader.bindings[index].binding == index);
		CHECK(shader.bindings[index].type == types[index]);
		CHECK(shader.bindings[index].is_used);
		CHECK(shader.bindings[index].is_arrayed == (index == 3));
	}
	CHECK(shader.local_size == glm::uvec3(8, 4, 1));
	CHECK(shader.push_constant_bytes == 0);
}

TEST_CASE("[SpirvReflection] the local size follows its specialization constant") {
	CHECK(reflect("tests/scale.comp").local_size.x == 1);
	CHECK(reflect("tests/scale.comp", { { 0, 32 } }).local_size.x == 32);
	CHECK(reflect("tests/scale.comp").push_constant_bytes == 8);
}

TEST_CASE("[SpirvReflection] what is declared and never touched is told apart") {
	for (const ReflectedBinding &binding : reflect("tests/scale.comp").bindings) {
		CHECK(binding.is_used == (binding.binding != 7));
	}
}

TEST_CASE("[SpirvReflection] words that are no SPIR-V are an error that names the shader") {
	const std::vector<uint32_t> words(16, 1);
	CHECK_THROWS_WITH_AS(reflect_spirv("a.comp", words, {}),
			"Shader \"a.comp\" holds no SPIR-V. Build it again.", Error);
	std::vector<uint32_t> cut;
	for (const uint32_t word : find_embedded_shader("tests/scale.comp")) {
		cut.push_back(word);
	}
	cut[5] = 0xffff0000u | (cut[5] & 0xffffu); // an instruction longer than the module
	CHECK_THROWS_AS(reflect_spirv("a.comp", cut, {}), Error);
}

TEST_CASE("[SpirvReflection] no embedded shader needs more than SPIR-V 1.3") {
	for (const EmbeddedShader &shader : get_embedded_shaders()) {
		CAPTURE(shader.name);
		REQUIRE(shader.spirv.size() > 1);
		CHECK(shader.spirv[1] <= 0x00010300u);
	}
}

TEST_CASE("[Access] a second reader in another stage is chained to the first") {
	const TextureRID texture{ 1 };
	const auto read_after = [&](Access p_before, Access p_after) {
		return compute_dependency({ .texture = texture, .before = p_before, .after = p_after });
	};
	CHECK_FALSE(read_after(Access::SHADER_READ_COMPUTE, Access::SHADER_READ_COMPUTE).is_needed);
	const Dependency chained =
			read_after(Access::SHADER_READ_FRAGMENT, Access::SHADER_READ_COMPUTE);
	CHECK(chained.is_needed);
	CHECK(chained.source_access == 0); // nothing new was written
	CHECK(read_after(Access::SHADER_READ_COMPUTE, Access::COPY_READ).is_needed); // other layout
	CHECK(read_after(Access::COLOR_WRITE, Access::COLOR_WRITE).is_needed);
}

TEST_CASE("[Access] a discarded texture waits for the earlier users of its memory") {
	const Dependency dependency = compute_dependency({ .texture = TextureRID{ 1 },
			.after = Access::COLOR_WRITE,
			.earlier_users = { Access::SHADER_WRITE_COMPUTE, Access::SHADER_READ_FRAGMENT } });
	CHECK(dependency.old_layout == VK_IMAGE_LAYOUT_UNDEFINED);
	CHECK((dependency.source_stages & VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT) != 0);
	CHECK((dependency.source_stages & VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT) != 0);
	CHECK(dependency.source_access == VK_ACCESS_2_SHADER_WRITE_BIT);
}

TEST_CASE("[Access] what the interface calls a write is one in Vulkan") {
	for (int index = 0; index <= static_cast<int>(Access::PRESENT); ++index) {
		CAPTURE(index);
		const Access access = static_cast<Access>(index);
		CHECK(is_write(access) == (get_write_access(access) != 0));
	}
}
