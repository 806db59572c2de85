#include "modules/rendering_device/resource_types.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[RenderingDevice] names, texel sizes and kinds of formats are looked up") {
	CHECK(get_texel_size_bytes(Format::R8_UNORM) == 1);
	CHECK(get_texel_size_bytes(Format::RGBA32_SFLOAT) == 16);
	CHECK(get_format_name(Format::D32_SFLOAT_S8_UINT) == std::string("D32_SFLOAT_S8_UINT"));
	CHECK(is_depth_format(Format::D32_SFLOAT));
	CHECK(is_depth_format(Format::D32_SFLOAT_S8_UINT));
	CHECK_FALSE(is_depth_format(Format::R32_SFLOAT));
	CHECK(has_stencil(Format::D32_SFLOAT_S8_UINT));
	CHECK_FALSE(has_stencil(Format::D32_SFLOAT));
	CHECK(is_uint_format(Format::RG32_UINT));
	CHECK_FALSE(is_uint_format(Format::RGBA8_UNORM));
}

TEST_CASE("[RenderingDevice] usages are listed by name") {
	CHECK(describe_usage(TextureUsage::SAMPLED | TextureUsage::STORAGE) == "SAMPLED | STORAGE");
}

TEST_CASE("[RenderingDevice] is_write is true for accesses that write and false for the others") {
	for (const Access access :
			{ Access::SHADER_WRITE_FRAGMENT, Access::SHADER_WRITE_COMPUTE, Access::COLOR_WRITE,
					Access::DEPTH_WRITE, Access::COPY_WRITE, Access::HOST_WRITE }) {
		CHECK(is_write(access));
	}
	for (const Access access : { Access::NONE, Access::VERTEX_READ, Access::INDIRECT_READ,
				 Access::CONDITIONAL_READ, Access::SHADER_READ_VERTEX, Access::SHADER_READ_FRAGMENT,
				 Access::SHADER_READ_COMPUTE, Access::UNIFORM_READ, Access::DEPTH_READ,
				 Access::COPY_READ, Access::HOST_READ, Access::PRESENT }) {
		CHECK_FALSE(is_write(access));
	}
}
