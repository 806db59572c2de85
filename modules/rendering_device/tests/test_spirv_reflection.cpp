#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/rendering_device/spirv_reflection.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

ReflectedShader reflect(
		std::string_view p_name, const std::vector<SpecializationConstant> &p_constants = {}) {
	return reflect_spirv(p_name, find_embedded_shader(p_name), p_constants);
}

const uint32_t LOCAL_SIZE_ID = 0; // constant_id of LOCAL_SIZE in scale.comp

} // namespace

TEST_CASE("[SpirvReflection] each kind of resource is recognised") {
	const ReflectedShader shader = reflect("tests/bindings.comp");
	const ResourceKind types[] = { ResourceKind::UNIFORM_BUFFER, ResourceKind::TEXEL_BUFFER,
		ResourceKind::TEXTURE_WITH_SAMPLER, ResourceKind::TEXTURE, ResourceKind::SAMPLER,
		ResourceKind::STORAGE_TEXTURE };
	REQUIRE(shader.bindings.size() == std::size(types));
	for (uint32_t index = 0; index < std::size(types); ++index) {
		CHECK(shader.bindings[index].binding == index);
		CHECK(shader.bindings[index].kind == types[index]);
		CHECK(shader.bindings[index].is_used);
		CHECK(shader.bindings[index].is_arrayed == (index == 3)); // a texture2DArray
	}
	CHECK(shader.local_size == glm::uvec3(8, 4, 1));
	CHECK(shader.push_constant_bytes == 0);
	CHECK(reflect("tests/scale.comp").bindings.at(0).kind == ResourceKind::STORAGE_BUFFER);
}

TEST_CASE("[SpirvReflection] the specialized local size and the size of push constants are found") {
	CHECK(reflect("tests/scale.comp").local_size.x == 64);
	CHECK(reflect("tests/scale.comp", { { LOCAL_SIZE_ID, 32 } }).local_size.x == 32);
	CHECK(reflect("tests/scale.comp").push_constant_bytes == 8);
}

TEST_CASE("[SpirvReflection] a binding that is declared but not accessed is marked as unused") {
	const ReflectedShader shader = reflect("tests/unused_binding.comp");
	REQUIRE(shader.bindings.size() == 3);
	for (const ReflectedBinding &binding : shader.bindings) {
		CHECK(binding.is_used == (binding.binding != 7)); // 7 is declared and never accessed
	}
}

TEST_CASE("[SpirvReflection] words that are not SPIR-V, and damaged SPIR-V, are an Error") {
	const std::vector<uint32_t> words(16, 1);
	CHECK_THROWS_WITH_AS(reflect_spirv("a.comp", words, {}),
			"Shader \"a.comp\" cannot be read as SPIR-V: Invalid SPIRV format. Build it again.",
			Error);
	CHECK_THROWS_AS(reflect_spirv("a.comp", {}, {}), Error);
	const std::span<const uint32_t> whole = find_embedded_shader("tests/scale.comp");
	std::vector<uint32_t> damaged(whole.begin(), whole.end());
	// The first word after the header: an instruction longer than the module, and one of no words.
	for (const uint32_t length_bits : { 0xffff0000u, 0u }) {
		damaged[5] = length_bits | (whole[5] & 0xffffu);
		CHECK_THROWS_AS(reflect_spirv("a.comp", damaged, {}), Error);
	}
	for (size_t count = 0; count < whole.size(); ++count) { // cut off after each word
		const std::vector<uint32_t> cut(whole.begin(), whole.begin() + ptrdiff_t(count));
		CHECK_THROWS_AS(reflect_spirv("a.comp", cut, {}), Error);
	}
}

TEST_CASE("[SpirvReflection] no embedded shader needs more than SPIR-V 1.3") {
	for (const EmbeddedShader &shader : get_embedded_shaders()) {
		CAPTURE(shader.name);
		REQUIRE(shader.spirv.size() > 1);
		CHECK(shader.spirv[1] <= 0x00010300u);
	}
}
