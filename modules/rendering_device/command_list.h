#pragma once

#include "modules/rendering_device/resource_types.h"

#include <memory>
#include <span>
#include <string>

namespace gnomon {

/// Records commands of one submission; got from RenderingDevice::begin_commands and valid until
/// submit_commands. All mistakes in the order of calls are assertions.
class CommandList {
public:
	struct Impl;
	explicit CommandList(Impl &p_impl) : impl(p_impl) {}

	/// A named span with timestamps around it; also the breadcrumb that a lost device reports.
	/// Spans do not nest and lie outside begin_rendering .. end_rendering.
	void begin_span(const std::string &p_name);
	void end_span();

	void barriers(std::span<const Barrier> p_barriers);

	/// Viewport and scissor cover the targets. Dynamic state starts as: no culling,
	/// counter-clockwise front faces as seen in a y-up view.
	void begin_rendering(std::span<const ColorTarget> p_colors, const DepthTarget *p_depth);
	/// For fragment shaders that only store into buffers and textures.
	void begin_rendering_without_targets(glm::uvec2 p_size_px);
	void end_rendering();
	void set_viewport(glm::uvec2 p_offset_px, glm::uvec2 p_size_px);
	/// Nothing outside is drawn; the next set_viewport covers all of it again.
	void set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px);
	/// Of the pipelines with has_depth_bounds; each begin_rendering sets 0 to 1.
	void set_depth_bounds(float p_least, float p_greatest);
	/// What stencils compare with and StencilOp::REPLACE writes, 0 to 255; each begin_rendering
	/// sets 0.
	void set_stencil_reference(uint32_t p_reference);
	void set_cull_mode(CullMode p_mode);
	/// Mirrored transforms wind their front faces the other way.
	enum class Winding { NORMAL, MIRRORED };
	void set_winding(Winding p_winding);

	void bind_pipeline(PipelineRID p_pipeline);
	/// All bindings that the bound pipeline declares, and no other: a missing or an extra one is an
	/// assertion that names pipeline and number.
	void bind_resources(std::span<const Binding> p_bindings);
	void bind_resources(std::initializer_list<Binding> p_bindings) {
		bind_resources(std::span<const Binding>(p_bindings.begin(), p_bindings.size()));
	}
	/// At most 128 bytes; the size must be what the shader's block has.
	void push_constants(std::span<const uint8_t> p_bytes);
	template <typename T>
	requires std::is_trivially_copyable_v<T> &&
			(!std::is_convertible_v<T, std::span<const uint8_t>>)void push_constants(
					const T &p_block) {
		push_constants(std::span(reinterpret_cast<const uint8_t *>(&p_block), sizeof(T)));
	}

	void bind_vertex_buffers(std::span<const BufferRID> p_buffers);
	void bind_index_buffer(BufferRID p_buffer); // uint32 indices
	void draw(uint32_t p_vertex_count, uint32_t p_instance_count = 1);
	void draw_indexed(uint32_t p_index_count, uint32_t p_first_index = 0);
	void draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes);
	/// Draws and dispatches until end_conditional happen only if the buffer's word at the offset
	/// is not 0 when the GPU gets there. Inside one rendering, or between two. Needs
	/// DeviceFeatures::conditional_rendering.
	void begin_conditional(BufferRID p_predicate, uint64_t p_offset_bytes = 0);
	void end_conditional();
	void dispatch(glm::uvec3 p_group_count);
	/// Enough groups of the bound pipeline's local size to cover the items.
	void dispatch_items(glm::uvec3 p_item_count);
	void dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes);

	void fill_buffer(BufferRID p_buffer, uint32_t p_value);
	void copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
			uint64_t p_source_offset_bytes = 0, uint64_t p_target_offset_bytes = 0);
	/// Tightly packed rows. Depth textures give their depth.
	void copy_texture_to_buffer(TextureRID p_source, BufferRID p_target, uint32_t p_layer = 0);
	void copy_buffer_to_texture(BufferRID p_source, TextureRID p_target, uint32_t p_layer = 0,
			uint64_t p_source_offset_bytes = 0);
	/// Any sizes and colour formats, nearest texel; brings a picture into a window. Layer 0, from
	/// COPY_READ to COPY_WRITE. sRGB formats are decoded and encoded, so values that are encoded
	/// already belong into RGBA8_UNORM. Integer formats only to integer formats; not for depth.
	void blit_texture(TextureRID p_source, TextureRID p_target);
	/// Same size and format.
	void copy_texture(TextureRID p_source, TextureRID p_target);
	/// The texture has Access::COPY_WRITE; of UINT formats: the value is converted.
	void clear_color(TextureRID p_texture, glm::vec4 p_value);

private:
	void begin_rendering_of_size(glm::uvec2 p_size_px, std::span<const ColorTarget> p_colors,
			const DepthTarget *p_depth);

	Impl &impl;
};

} // namespace gnomon
