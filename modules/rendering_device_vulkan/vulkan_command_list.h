#pragma once

#include "modules/rendering_device/command_list.h"
#include "modules/rendering_device_vulkan/vulkan_handles.h"

#include <optional>
#include <vector>

namespace gnomon {

class VulkanDevice;
struct BufferResource;
struct PipelineResource;
struct TextureResource;

/// Records into the command buffer of one submission. Assigning a new command list resets the
/// state.
class VulkanCommandList final : public CommandList {
public:
	// gpu_spans.cpp
	void begin_span(const std::string &p_name, bool p_needs_time = false) override;
	void end_span() override;

	// command_list.cpp
	void barriers(std::span<const Barrier> p_barriers) override;
	void bind_pipeline(PipelineRID p_pipeline) override;
	void push_constants(std::span<const uint8_t> p_bytes) override;
	void dispatch(glm::uvec3 p_group_count) override;
	void dispatch_items(glm::uvec3 p_item_count) override;
	void dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) override;

	// descriptors.cpp
	void bind_resources(std::span<const Binding> p_bindings) override;

	// command_list_raster.cpp
	void begin_rendering(
			std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) override;
	void begin_rendering_without_targets(glm::uvec2 p_size_px) override;
	void end_rendering() override;
	void set_viewport(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) override;
	void set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) override;
	void set_depth_bounds(float p_min, float p_max) override;
	void bind_vertex_buffers(std::span<const BufferRID> p_buffers) override;
	void bind_index_buffer(BufferRID p_buffer) override;
	void draw(uint32_t p_vertex_count, uint32_t p_instance_count) override;
	void draw_indexed(uint32_t p_index_count, uint32_t p_first_index) override;
	void draw_instances(
			uint32_t p_index_count, uint32_t p_instance_count, uint32_t p_first_instance) override;
	void draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) override;
	void begin_conditional(BufferRID p_predicate, uint64_t p_offset_bytes) override;
	void end_conditional() override;
	void clear_color(TextureRID p_texture, glm::vec4 p_value, uint32_t p_layer) override;

	// command_list_copies.cpp
	void clear_buffer(BufferRID p_buffer) override;
	void copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
			uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) override;
	void copy_texture_to_buffer(TextureRID p_source, BufferRID p_target, uint32_t p_layer) override;
	void copy_buffer_to_texture(BufferRID p_source, TextureRID p_target, uint32_t p_layer,
			uint64_t p_source_offset_bytes) override;
	void copy_texture(TextureRID p_source, TextureRID p_target) override;

	// The same copies for read_backs.cpp, whose staging buffers have no handles.
	void copy_buffer(const BufferResource &p_source, const BufferResource &p_target,
			uint64_t p_size_bytes, uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes);
	void copy_texture_to_buffer(
			const TextureResource &p_source, const BufferResource &p_target, uint32_t p_layer);

	// State while recording, between begin_commands and submit_commands.
	VulkanDevice *device = nullptr;
	VkCommandBuffer commands = VK_NULL_HANDLE;
	bool is_recording = false;
	bool is_in_span = false;
	bool is_rendering = false;
	bool is_conditional = false;

private:
	void begin_rendering_of_size(glm::uvec2 p_size_px, std::span<const ColorTarget> p_colors,
			const DepthTarget *p_depth);
	// Assert that a call is allowed now. p_call: its name, for the message.
	void check_recording(const char *p_call) const;
	void check_draw(const char *p_call) const;
	void check_dispatch(const char *p_call) const;
	void check_bound(const char *p_call) const;
	void check_copy(const char *p_call) const;
	void push_barrier(const Barrier &p_barrier, std::vector<VkBufferMemoryBarrier2> &r_buffers,
			std::vector<VkImageMemoryBarrier2> &r_images);

	/// Called before each draw with its triangles. If they and those drawn since the last part
	/// began are more than VulkanDevice::max_part_triangles, ends the part after all work in it and
	/// begins the next one. The image is the same.
	void begin_part_if_full(uint64_t p_triangle_count);

	// Of begin_rendering, to continue into the same targets.
	VkRenderingInfo rendering = {};
	std::vector<VkRenderingAttachmentInfo> color_attachments;
	VkRenderingAttachmentInfo depth_attachment = {};
	uint64_t part_triangle_count = 0; // drawn since the part began
	std::vector<Format> target_color_formats;
	std::optional<Format> target_depth_format;
	bool is_target_depth_read_only = false;
	const PipelineResource *bound_pipeline = nullptr;
	bool are_resources_bound = false;
	bool are_constants_pushed = false;
	uint32_t bound_vertex_buffer_count = 0;
	bool is_index_buffer_bound = false;
};

} // namespace gnomon
