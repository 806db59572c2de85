#include "modules/rendering_device_godot/godot_compile_list.h"

#include "modules/rendering_device_godot/godot_device.h"

namespace gnomon {

void GodotCompileList::free_resources() {
	if (no_work.id != 0) {
		device.free(no_work);
		no_work = {};
	}
}

void GodotCompileList::barriers(std::span<const Barrier> p_barriers) {
	device.barriers(p_barriers);
}

void GodotCompileList::begin_rendering(
		std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) {
	framebuffer_format =
			device.rd.framebuffer_get_format(device.get_framebuffer(p_colors, p_depth));
}

void GodotCompileList::begin_rendering_without_targets(glm::uvec2 p_size_px) {
	framebuffer_format = device.rd.framebuffer_get_format(device.get_empty_framebuffer(p_size_px));
}

void GodotCompileList::bind_pipeline(PipelineRID p_pipeline) {
	GodotPipeline &pipeline = device.pipelines[device.get_index(p_pipeline)];
	const bool is_compute = std::holds_alternative<ComputePipelineDesc>(pipeline.desc);
	const int64_t format = is_compute ? 0 : framebuffer_format;
	is_new = false;
	if (compilations_left == 0 || pipeline.by_framebuffer_format.contains(format)) {
		return;
	}
	--compilations_left;
	if (is_compute) {
		device.bind_pipeline(p_pipeline); // compiles it
		is_new = true;
	} else {
		device.compile(pipeline, format);
	}
}

void GodotCompileList::bind_resources(std::span<const Binding> p_bindings) {
	if (is_new) {
		device.bind_resources(p_bindings);
	}
}

void GodotCompileList::push_constants(std::span<const uint8_t> p_bytes) {
	if (is_new) {
		device.push_constants(p_bytes);
	}
}

void GodotCompileList::copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
		uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) {
	device.copy_buffer(
			p_source, p_target, p_size_bytes, p_source_offset_bytes, p_target_offset_bytes);
}

void GodotCompileList::dispatch_nothing() {
	if (!is_new) {
		return;
	}
	is_new = false;
	if (no_work.id == 0) {
		const uint32_t zeros[3] = {};
		no_work = device.create_buffer_with_data(
				{ "no work", sizeof(zeros), BufferUsage::INDIRECT | BufferUsage::STORAGE },
				std::span(reinterpret_cast<const uint8_t *>(zeros), sizeof(zeros)));
	}
	device.dispatch_indirect(no_work, 0);
}

} // namespace gnomon
