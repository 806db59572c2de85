#include "modules/rendering_device_vulkan/access.h"

#include <doctest/doctest.h>

using namespace gnomon;

TEST_CASE("[Access] only a reader in the stage and layout of the one before needs no barrier") {
	const TextureRID texture{ 1 };
	const auto compute = [&](Access p_before, Access p_after) {
		return compute_dependency({ .texture = texture, .before = p_before, .after = p_after });
	};
	CHECK_FALSE(compute(Access::SHADER_READ_COMPUTE, Access::SHADER_READ_COMPUTE).is_needed);
	const Dependency chained = compute(Access::SHADER_READ_FRAGMENT, Access::SHADER_READ_COMPUTE);
	CHECK(chained.is_needed);
	CHECK(chained.source_access == 0); // nothing new was written
	CHECK(compute(Access::SHADER_READ_COMPUTE, Access::COPY_READ).is_needed); // other layout
	CHECK(compute(Access::COLOR_WRITE, Access::COLOR_WRITE).is_needed);
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

TEST_CASE("[Access] is_write is true exactly for accesses with Vulkan write flags") {
	for (int index = 0; index <= static_cast<int>(Access::PRESENT); ++index) {
		CAPTURE(index);
		const Access access = static_cast<Access>(index);
		CHECK(is_write(access) == (get_write_access(access) != 0));
	}
}
