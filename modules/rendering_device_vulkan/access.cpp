#include "modules/rendering_device_vulkan/access.h"

#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_formats.h"

namespace gnomon {

namespace {

/// The stages, accesses and layout of one Access in Vulkan.
struct AccessScope {
	VkPipelineStageFlags2 stages = 0;
	VkAccessFlags2 access = 0;
	VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED; // of a texture in this use
};

constexpr VkPipelineStageFlags2 DEPTH_STAGES =
		VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
// Covers the geometry stage too, whose own bit is only allowed if geometryShader is enabled.
constexpr VkPipelineStageFlags2 VERTEX_STAGES = VK_PIPELINE_STAGE_2_PRE_RASTERIZATION_SHADERS_BIT;
constexpr VkAccessFlags2 SHADER_ACCESS = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT;
constexpr VkAccessFlags2 WRITES = VK_ACCESS_2_SHADER_WRITE_BIT |
		VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
		VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

// In the order of Access. Textures that shaders only read are in SHADER_READ_ONLY, both depth and
// colour: a pass that only reads a storage texture binds it as a sampled one, so that reading needs
// one layout.
const AccessScope SCOPES[] = {
	/* NONE */ { VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_UNDEFINED },
	/* VERTEX_READ */
	{ VK_PIPELINE_STAGE_2_VERTEX_INPUT_BIT,
			VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT | VK_ACCESS_2_INDEX_READ_BIT,
			VK_IMAGE_LAYOUT_UNDEFINED },
	/* INDIRECT_READ */
	{ VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
			VK_IMAGE_LAYOUT_UNDEFINED },
	/* CONDITIONAL_READ */
	{ VK_PIPELINE_STAGE_2_CONDITIONAL_RENDERING_BIT_EXT,
			VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT, VK_IMAGE_LAYOUT_UNDEFINED },
	/* SHADER_READ_VERTEX */
	{ VERTEX_STAGES, VK_ACCESS_2_SHADER_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
	/* SHADER_READ_FRAGMENT */
	{ VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
			VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
	/* SHADER_READ_COMPUTE */
	{ VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT,
			VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL },
	/* UNIFORM_READ */
	{ VERTEX_STAGES | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT |
					VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
			VK_ACCESS_2_UNIFORM_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
			VK_IMAGE_LAYOUT_UNDEFINED },
	/* SHADER_WRITE_FRAGMENT */
	{ VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, SHADER_ACCESS, VK_IMAGE_LAYOUT_GENERAL },
	/* SHADER_WRITE_COMPUTE */
	{ VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, SHADER_ACCESS, VK_IMAGE_LAYOUT_GENERAL },
	/* COLOR_WRITE */
	{ VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
			VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT,
			VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL },
	/* DEPTH_WRITE */
	{ DEPTH_STAGES,
			VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
					VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT,
			VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL },
	/* DEPTH_READ */
	{ DEPTH_STAGES, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
			VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL },
	/* COPY_READ */
	{ VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
			VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL },
	/* COPY_WRITE */
	{ VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
			VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL },
	/* HOST_READ */
	{ VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED },
	/* HOST_WRITE */
	{ VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_WRITE_BIT, VK_IMAGE_LAYOUT_UNDEFINED },
	/* PRESENT: the semaphore that presenting waits for does the rest */
	{ VK_PIPELINE_STAGE_2_NONE, 0, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR },
};
static_assert(std::size(SCOPES) == static_cast<size_t>(Access::PRESENT) + 1);

const AccessScope &get_access_scope(Access p_access) {
	const size_t index = static_cast<size_t>(p_access);
	GNOMON_ASSERT(index < std::size(SCOPES), "access ", index);
	return SCOPES[index];
}

} // namespace

VkAccessFlags2 get_write_access(Access p_access) {
	return get_access_scope(p_access).access & WRITES;
}

VkImageLayout get_layout_for_format(VkImageLayout p_layout, Format p_format) {
	if (!has_stencil(p_format)) {
		return p_layout;
	}
	switch (p_layout) {
		case VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL:
			return VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
		case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL:
			return VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
		default:
			return p_layout;
	}
}

Dependency compute_dependency(const Barrier &p_barrier) {
	const AccessScope &before = get_access_scope(p_barrier.before);
	const AccessScope &after = get_access_scope(p_barrier.after);
	Dependency dependency = { before.stages, get_write_access(p_barrier.before), after.stages,
		after.access, before.layout, after.layout, /*is_needed=*/true };
	const bool is_texture = bool(p_barrier.texture);
	if (p_barrier.before == Access::NONE) {
		// Each command list begins with a full barrier. With the stages of the next use as source
		// stages, the layout transition waits for that barrier, and through it for all accesses of
		// earlier submissions.
		dependency.source_stages = after.stages;
		for (Access user : p_barrier.earlier_users) {
			dependency.source_stages |= get_access_scope(user).stages;
			dependency.source_access |= get_write_access(user);
		}
		// A buffer without earlier users needs nothing: the full barrier suffices.
		dependency.is_needed = is_texture || !p_barrier.earlier_users.empty();
		return dependency;
	}
	if (!is_write(p_barrier.before) && !is_write(p_barrier.after)) {
		// A later reader in another stage still has to be chained to the write that the first
		// reader waited for.
		const bool is_covered =
				(after.stages & ~before.stages) == 0 && (after.access & ~before.access) == 0;
		const bool keeps_layout = !is_texture || before.layout == after.layout;
		dependency.is_needed = !is_covered || !keeps_layout;
	}
	return dependency;
}

} // namespace gnomon
