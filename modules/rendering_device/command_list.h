#pragma once

#include "modules/rendering_device/resource_types.h"

#include <span>
#include <string>

namespace gnomon {

/// Records the commands of one submission. RenderingDevice::begin_commands returns it; it is valid
/// until submit_commands or abandon_commands. Calls in a wrong order are assertions.
class CommandList {
public:
	virtual ~CommandList() = default;

	/// Begins a named span, whose GPU time is measured with timestamps. If the device is lost, the
	/// error names the last span that began. Spans do not nest, and they begin and end outside
	/// begin_rendering .. end_rendering. p_needs_time: a device that times only few spans (Godot's)
	/// times this one.
	virtual void begin_span(const std::string &p_name, bool p_needs_time = false) = 0;
	virtual void end_span() = 0;

	/// Records barriers, outside begin_rendering .. end_rendering.
	virtual void barriers(std::span<const Barrier> p_barriers) = 0;

	/// Begins rendering into the targets, which have the same size. p_depth may be null if there
	/// are colour targets. Viewport and scissor are set to cover the targets.
	virtual void begin_rendering(
			std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) = 0;
	/// Begins rendering without attachments, for fragment shaders that only store into buffers and
	/// textures.
	virtual void begin_rendering_without_targets(glm::uvec2 p_size_px) = 0;
	virtual void end_rendering() = 0;
	/// Sets the viewport, and the scissor rectangle to the same area. Not supported inside Godot,
	/// which draws into whole targets.
	virtual void set_viewport(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) = 0;
	/// Restricts drawing to the rectangle. The next set_viewport resets it to the whole viewport.
	virtual void set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) = 0;
	/// Sets the range of stored depths, within 0..1, in which pipelines with has_depth_bounds draw.
	/// Each begin_rendering resets it to 0..1.
	virtual void set_depth_bounds(float p_min, float p_max) = 0;

	virtual void bind_pipeline(PipelineRID p_pipeline) = 0;
	/// Binds the resources of the bound pipeline, one for each binding that its shaders use. A
	/// missing or an undeclared one is an assertion that names the pipeline and the binding number.
	virtual void bind_resources(std::span<const Binding> p_bindings) = 0;
	void bind_resources(std::initializer_list<Binding> p_bindings) {
		bind_resources(std::span<const Binding>(p_bindings.begin(), p_bindings.size()));
	}
	/// Sets the push constants of the bound pipeline: at most 128 bytes. The size must equal that
	/// of the shader's block, with both rounded up to 16 bytes, and be a multiple of 4 bytes.
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
	/// Draws all indices p_instance_count times; gl_InstanceIndex begins at p_first_instance.
	virtual void draw_instances(
			uint32_t p_index_count, uint32_t p_instance_count, uint32_t p_first_instance) = 0;
	/// The buffer contains, at the offset, the uint32 vertex count, instance count, first vertex
	/// and first instance index.
	virtual void draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) = 0;
	/// The GPU skips draws and dispatches until end_conditional if the uint32 in the buffer at the
	/// offset is 0 when it executes them. Both calls are inside the same begin_rendering ..
	/// end_rendering, or outside with no begin_rendering between them. Needs
	/// DeviceFeatures::conditional_rendering.
	virtual void begin_conditional(BufferRID p_predicate, uint64_t p_offset_bytes = 0) = 0;
	virtual void end_conditional() = 0;
	virtual void dispatch(glm::uvec3 p_group_count) = 0;
	/// Dispatches enough workgroups of the bound pipeline's local size to cover the items.
	virtual void dispatch_items(glm::uvec3 p_item_count) = 0;
	/// The buffer contains, at the offset, the uint32 workgroup counts along x, y and z.
	virtual void dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) = 0;

	/// Sets all bytes to 0. For other values see add_fill_pass of the render graph.
	virtual void clear_buffer(BufferRID p_buffer) = 0;
	virtual void copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
			uint64_t p_source_offset_bytes = 0, uint64_t p_target_offset_bytes = 0) = 0;
	/// Copies one layer into tightly packed rows; of a depth texture, the depth. Formats with a
	/// stencil cannot be copied.
	virtual void copy_texture_to_buffer(
			TextureRID p_source, BufferRID p_target, uint32_t p_layer = 0) = 0;
	/// Copies tightly packed rows into one layer. A buffer in GPU memory needs
	/// DeviceFeatures::copies_to_textures.
	virtual void copy_buffer_to_texture(BufferRID p_source, TextureRID p_target,
			uint32_t p_layer = 0, uint64_t p_source_offset_bytes = 0) = 0;
	/// Both textures must have the same size and format.
	virtual void copy_texture(TextureRID p_source, TextureRID p_target) = 0;
	/// Clears a colour texture, which must be in Access::COPY_WRITE: one layer, or all. For
	/// R32_UINT and RG32_UINT the value is converted to integers. RGBA32_UINT is not supported.
	virtual void clear_color(
			TextureRID p_texture, glm::vec4 p_value, uint32_t p_layer = Binding::ALL_LAYERS) = 0;

protected:
	CommandList() = default;
	CommandList(const CommandList &) = default;
	CommandList &operator=(const CommandList &) = default;
};

} // namespace gnomon
