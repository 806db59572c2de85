#pragma once

#include "modules/rendering_device/resource_types.h"

#include <span>
#include <string>

namespace gnomon {

/// Records commands of one submission; got from RenderingDevice::begin_commands and valid until
/// submit_commands. All errors in the order of calls are assertions.
class CommandList {
public:
	virtual ~CommandList() = default;

	/// Begins a named span with timestamps around it; it is also the breadcrumb that a lost device
	/// reports. Spans do not nest and are outside begin_rendering .. end_rendering.
	virtual void begin_span(const std::string &p_name) = 0;
	virtual void end_span() = 0;

	virtual void barriers(std::span<const Barrier> p_barriers) = 0;

	/// Viewport and scissor cover the targets.
	virtual void begin_rendering(
			std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) = 0;
	/// For fragment shaders that only store into buffers and textures.
	virtual void begin_rendering_without_targets(glm::uvec2 p_size_px) = 0;
	virtual void end_rendering() = 0;
	virtual void set_viewport(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) = 0;
	/// Nothing outside the rectangle is drawn; the next set_viewport resets it to the whole
	/// viewport.
	virtual void set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) = 0;
	/// Applies to pipelines with has_depth_bounds; each begin_rendering resets it to 0..1.
	virtual void set_depth_bounds(float p_least, float p_greatest) = 0;

	virtual void bind_pipeline(PipelineRID p_pipeline) = 0;
	/// Binds exactly the bindings that the bound pipeline declares: a missing or an extra one is an
	/// assertion that names pipeline and number.
	virtual void bind_resources(std::span<const Binding> p_bindings) = 0;
	void bind_resources(std::initializer_list<Binding> p_bindings) {
		bind_resources(std::span<const Binding>(p_bindings.begin(), p_bindings.size()));
	}
	/// At most 128 bytes; the size must equal that of the shader's block.
	virtual void push_constants(std::span<const uint8_t> p_bytes) = 0;
	template <typename T>
	requires std::is_trivially_copyable_v<T> &&
			(!std::is_convertible_v<T, std::span<const uint8_t>>)void push_constants(
					const T &p_block) {
		push_constants(std::span(reinterpret_cast<const uint8_t *>(&p_block), sizeof(T)));
	}

	virtual void bind_vertex_buffers(std::span<const BufferRID> p_buffers) = 0;
	virtual void bind_index_buffer(BufferRID p_buffer) = 0; // uint32 indices
	virtual void draw(uint32_t p_vertex_count, uint32_t p_instance_count = 1) = 0;
	virtual void draw_indexed(uint32_t p_index_count, uint32_t p_first_index = 0) = 0;
	virtual void draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) = 0;
	/// Draws and dispatches until end_conditional happen only if the buffer's word at the offset
	/// is not 0 when the GPU gets there. Inside one rendering, or between two. Needs
	/// DeviceFeatures::conditional_rendering.
	virtual void begin_conditional(BufferRID p_predicate, uint64_t p_offset_bytes = 0) = 0;
	virtual void end_conditional() = 0;
	virtual void dispatch(glm::uvec3 p_group_count) = 0;
	/// Dispatches enough workgroups of the bound pipeline's local size to cover the items.
	virtual void dispatch_items(glm::uvec3 p_item_count) = 0;
	virtual void dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) = 0;

	/// Sets all bytes to 0. For other values see add_fill_pass of the render graph.
	virtual void clear_buffer(BufferRID p_buffer) = 0;
	virtual void copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
			uint64_t p_source_offset_bytes = 0, uint64_t p_target_offset_bytes = 0) = 0;
	/// Rows are tightly packed. Depth textures copy their depth aspect.
	virtual void copy_texture_to_buffer(
			TextureRID p_source, BufferRID p_target, uint32_t p_layer = 0) = 0;
	virtual void copy_buffer_to_texture(BufferRID p_source, TextureRID p_target,
			uint32_t p_layer = 0, uint64_t p_source_offset_bytes = 0) = 0;
	/// Both textures must have the same size and format.
	virtual void copy_texture(TextureRID p_source, TextureRID p_target) = 0;
	/// The texture must be in Access::COPY_WRITE; for UINT formats the value is converted.
	virtual void clear_color(TextureRID p_texture, glm::vec4 p_value) = 0;

protected:
	CommandList() = default;
	CommandList(const CommandList &) = default;
	CommandList &operator=(const CommandList &) = default;
};

} // namespace gnomon
