#pragma once

#include "modules/rendering_device/command_list.h"

#include <godot_api.gen.h>

#include <cstdint>

namespace gnomon {

class GodotDevice;
struct GodotPipeline;

/// Commands that compile pipelines instead of executing: a limited number of those that are bound
/// for the first time. Compute pipelines are also dispatched, with no work groups, since software
/// drivers compile them when they are executed. Only copies of buffers are executed, which upload
/// what later frames use.
class GodotCompileList final : public CommandList {
public:
	explicit GodotCompileList(GodotDevice &r_device) : device(r_device) {}
	/// Call it before the device is destroyed.
	void free_resources();

	/// p_count: the maximum number of pipelines that are compiled until the next call.
	void set_limit(uint32_t p_count) { compilations_left = p_count; }
	uint32_t get_compilations_left() const { return compilations_left; }

	void begin_span(const std::string &, bool) override {}
	void end_span() override {}
	void barriers(std::span<const Barrier> p_barriers) override;
	void begin_rendering(
			std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) override;
	void begin_rendering_without_targets(glm::uvec2 p_size_px) override;
	void end_rendering() override {}
	void set_viewport(glm::uvec2, glm::uvec2) override {}
	void set_scissor(glm::uvec2, glm::uvec2) override {}
	void set_depth_bounds(float, float) override {}
	void bind_pipeline(PipelineRID p_pipeline) override;
	void bind_resources(std::span<const Binding> p_bindings) override;
	void push_constants(std::span<const uint8_t> p_bytes) override;
	void bind_vertex_buffers(std::span<const BufferRID>) override {}
	void bind_index_buffer(BufferRID) override {}
	void draw(uint32_t, uint32_t) override {}
	void draw_indexed(uint32_t, uint32_t) override {}
	void draw_instances(uint32_t, uint32_t, uint32_t) override {}
	void draw_indirect(BufferRID, uint64_t) override {}
	void begin_conditional(BufferRID, uint64_t) override {}
	void end_conditional() override {}
	void dispatch(glm::uvec3) override { dispatch_nothing(); }
	void dispatch_items(glm::uvec3) override { dispatch_nothing(); }
	void dispatch_indirect(BufferRID, uint64_t) override { dispatch_nothing(); }
	void clear_buffer(BufferRID) override {}
	void copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
			uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) override;
	void copy_texture_to_buffer(TextureRID, BufferRID, uint32_t) override {}
	void copy_buffer_to_texture(BufferRID, TextureRID, uint32_t, uint64_t) override {}
	void copy_texture(TextureRID, TextureRID) override {}
	void clear_color(TextureRID, glm::vec4, uint32_t) override {}

private:
	void dispatch_nothing();

	GodotDevice &device;
	uint32_t compilations_left = 0;
	bool is_new = false;			// a compute pipeline is bound that was just compiled
	int64_t framebuffer_format = 0; // of begin_rendering
	BufferRID no_work;				// the arguments of a dispatch of no work groups
};

} // namespace gnomon
