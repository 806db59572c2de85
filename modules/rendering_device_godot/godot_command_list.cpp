// The commands of GodotDevice.

#include "modules/core/error.h"
#include "modules/rendering_device/work_groups.h"
#include "modules/rendering_device_godot/godot_device.h"
#include "modules/rendering_device_godot/godot_formats.h"

#include <algorithm>
#include <cstring>

namespace gnomon {

using RD = godot::RenderingDevice;
using godot::Array;
using godot::PackedByteArray;
using godot::PackedColorArray;
using godot::Ref;
using godot::Variant;

namespace {

int64_t to_godot_uniform(ResourceKind p_kind) {
	switch (p_kind) {
		case ResourceKind::UNIFORM_BUFFER:
			return RD::UNIFORM_TYPE_UNIFORM_BUFFER;
		case ResourceKind::STORAGE_BUFFER:
			return RD::UNIFORM_TYPE_STORAGE_BUFFER;
		case ResourceKind::TEXEL_BUFFER:
			return RD::UNIFORM_TYPE_TEXTURE_BUFFER;
		case ResourceKind::STORAGE_TEXTURE:
			return RD::UNIFORM_TYPE_IMAGE;
		case ResourceKind::TEXTURE:
			return RD::UNIFORM_TYPE_TEXTURE;
		case ResourceKind::TEXTURE_WITH_SAMPLER:
			return RD::UNIFORM_TYPE_SAMPLER_WITH_TEXTURE;
		case ResourceKind::SAMPLER:
			return RD::UNIFORM_TYPE_SAMPLER;
	}
	return RD::UNIFORM_TYPE_MAX;
}

} // namespace

void GodotDevice::begin_span(const std::string &p_name, bool p_needs_time) {
	end_compute_list();
	if (p_needs_time || is_span_timed) { // the end of one is the beginning of the next
		rd.capture_timestamp(p_needs_time ? std::string(TIMED_SPAN_PREFIX) + p_name : "");
		is_any_timed = true;
	}
	is_span_timed = p_needs_time;
	const auto timed = timed_ms.find(p_name);
	spans.push_back({ p_name, p_needs_time && timed != timed_ms.end() ? timed->second : 0 });
}

void GodotDevice::end_span() {
	end_compute_list();
}

void GodotDevice::barriers(std::span<const Barrier>) {
	end_compute_list(); // Godot synchronises one list with the next
}

void GodotDevice::begin_compute_list() {
	GNOMON_ASSERT(
			draw_list < 0, "a compute pipeline is bound inside begin_rendering .. end_rendering");
	if (compute_list < 0) {
		flush_uploads();
		compute_list = rd.compute_list_begin();
	}
}

void GodotDevice::end_compute_list() {
	if (compute_list >= 0) {
		rd.compute_list_end();
		compute_list = -1;
		bound = nullptr;
	}
}

godot::RID GodotDevice::get_framebuffer(
		std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) {
	Key key;
	for (const ColorTarget &color : p_colors) {
		key.push_back(get_layer(textures.get(color.texture), color.layer).id);
	}
	if (p_depth) {
		key.push_back(get_layer(textures.get(p_depth->texture), p_depth->layer).id);
	}
	Cached &cached = framebuffers[key];
	if (!cached.rid || !rd.framebuffer_is_valid(cached.rid)) {
		Array attachments;
		for (const uint64_t id : key) {
			attachments.append(Variant(godot::RID{ id }));
		}
		cached.rid = rd.framebuffer_create(
				attachments, /*p_validate_with_format=*/-1, /*p_view_count=*/1);
		GNOMON_ASSERT(cached.rid, "Godot refuses a framebuffer of ", key.size(), " textures");
	}
	cached.last_use = submission;
	return cached.rid;
}

void GodotDevice::begin_draw_list(godot::RID p_framebuffer, int64_t p_flags,
		std::span<const glm::vec4> p_clear_colors, float p_clear_depth) {
	end_compute_list();
	flush_uploads();
	framebuffer_format = rd.framebuffer_get_format(p_framebuffer);
	draw_list = rd.draw_list_begin(p_framebuffer, p_flags, PackedColorArray(p_clear_colors),
			double(p_clear_depth), /*p_clear_stencil_value=*/0, /*p_region=*/{},
			/*p_breadcrumb=*/0);
	GNOMON_ASSERT(draw_list >= 0, "Godot refuses to begin a draw list");
}

void GodotDevice::begin_rendering(
		std::span<const ColorTarget> p_colors, const DepthTarget *p_depth) {
	int64_t flags = 0;
	std::vector<glm::vec4> clear_colors;
	for (size_t index = 0; index < p_colors.size(); ++index) {
		const ColorTarget &color = p_colors[index];
		const TextureDesc &desc = textures.get(color.texture).desc;
		clear_colors.push_back(to_godot_clear_value(desc.format, color.clear));
		flags |= color.load == LoadOp::CLEAR	? RD::DRAW_CLEAR_COLOR_0 << index
				: color.load == LoadOp::DISCARD ? RD::DRAW_IGNORE_COLOR_0 << index
												: 0;
	}
	if (p_depth) {
		const TextureDesc &desc = textures.get(p_depth->texture).desc;
		if (p_depth->load == LoadOp::CLEAR) {
			flags |= RD::DRAW_CLEAR_DEPTH |
					(has_stencil(desc.format) ? int64_t(RD::DRAW_CLEAR_STENCIL) : 0);
		} else if (p_depth->load == LoadOp::DISCARD) {
			flags |= RD::DRAW_IGNORE_DEPTH |
					(has_stencil(desc.format) ? int64_t(RD::DRAW_IGNORE_STENCIL) : 0);
		}
	}
	const godot::RID framebuffer = get_framebuffer(p_colors, p_depth);
	begin_draw_list(framebuffer, flags, clear_colors, p_depth ? p_depth->clear : 0.0f);
}

godot::RID GodotDevice::get_empty_framebuffer(glm::uvec2 p_size_px) {
	Cached &cached = framebuffers[{ p_size_px.x, p_size_px.y }];
	if (!cached.rid) {
		cached.rid = rd.framebuffer_create_empty(
				glm::ivec2(p_size_px), /*p_samples=*/0, /*p_validate_with_format=*/-1);
	}
	cached.last_use = submission;
	return cached.rid;
}

void GodotDevice::begin_rendering_without_targets(glm::uvec2 p_size_px) {
	begin_draw_list(get_empty_framebuffer(p_size_px), /*p_flags=*/0, /*p_clear_colors=*/{},
			/*p_clear_depth=*/0.0f);
}

void GodotDevice::end_rendering() {
	rd.draw_list_end();
	draw_list = -1;
	bound = nullptr;
	vertex_buffers.clear();
	index_buffer = {};
}

void GodotDevice::set_viewport(glm::uvec2, glm::uvec2) {
	GNOMON_ASSERT(false, "set_viewport: Godot draws into whole targets; use set_scissor");
}

void GodotDevice::set_scissor(glm::uvec2 p_offset_px, glm::uvec2 p_size_px) {
	rd.draw_list_enable_scissor(draw_list, { glm::vec2(p_offset_px), glm::vec2(p_size_px) });
}

void GodotDevice::set_depth_bounds(float, float) {
	GNOMON_ASSERT(false, "this device has no depth bounds");
}

void GodotDevice::begin_conditional(BufferRID, uint64_t) {
	GNOMON_ASSERT(false, "this device has no conditional rendering");
}

void GodotDevice::end_conditional() {
	GNOMON_ASSERT(false, "this device has no conditional rendering");
}

void GodotDevice::bind_pipeline(PipelineRID p_pipeline) {
	GodotPipeline &pipeline = pipelines[get_index(p_pipeline)];
	bound = &pipeline;
	if (std::holds_alternative<ComputePipelineDesc>(pipeline.desc)) {
		const godot::RID rid = compile(pipeline, /*p_framebuffer_format=*/0);
		begin_compute_list();
		rd.compute_list_bind_compute_pipeline(compute_list, rid);
		return;
	}
	GNOMON_ASSERT(draw_list >= 0, "raster pipeline '", pipeline.name,
			"' is bound outside begin_rendering .. end_rendering");
	rd.draw_list_bind_render_pipeline(draw_list, compile(pipeline, framebuffer_format));
}

godot::RID GodotDevice::get_uniform_set(
		const GodotPipeline &p_pipeline, std::span<const Binding> p_bindings) {
	struct Slot {
		const ReflectedBinding *reflected;
		godot::RID resource;
		godot::RID sampler;
	};
	std::vector<Slot> slots;
	Key key = { p_pipeline.shader.id };
	for (const ReflectedBinding &reflected : p_pipeline.bindings) {
		const auto given = std::find_if(p_bindings.begin(), p_bindings.end(),
				[&](const Binding &p_binding) { return p_binding.binding == reflected.binding; });
		// Godot wants a resource for a binding that is only declared, too.
		GNOMON_ASSERT(given != p_bindings.end(), "pipeline '", p_pipeline.name, "': binding ",
				reflected.binding, " is missing");
		Slot slot = { &reflected, {}, {} };
		if (given->buffer) {
			slot.resource = buffers.get(given->buffer).rid;
		} else if (given->texture) {
			slot.resource = get_layer(textures.get(given->texture), given->layer);
		}
		if (given->sampler) {
			slot.sampler = samplers.get(given->sampler).rid;
		}
		key.insert(key.end(), { reflected.binding, slot.resource.id, slot.sampler.id });
		slots.push_back(slot);
	}
	if (slots.empty()) {
		return {};
	}
	Cached &cached = uniform_sets[key];
	if (!cached.rid || !rd.uniform_set_is_valid(cached.rid)) {
		Array uniforms;
		for (const Slot &slot : slots) {
			const auto uniform = Ref<godot::RDUniform>::create();
			uniform.set_uniform_type(to_godot_uniform(slot.reflected->kind));
			uniform.set_binding(slot.reflected->binding);
			if (slot.sampler) {
				uniform.add_id(slot.sampler);
			}
			if (slot.resource) {
				uniform.add_id(slot.resource);
			}
			uniforms.append(Variant::of_object(uniform.get_object()));
		}
		cached.rid = rd.uniform_set_create(uniforms, p_pipeline.shader, 0);
		GNOMON_ASSERT(cached.rid, "pipeline '", p_pipeline.name, "': Godot refuses its resources");
	}
	cached.last_use = submission;
	return cached.rid;
}

void GodotDevice::bind_resources(std::span<const Binding> p_bindings) {
	const godot::RID set = get_uniform_set(*bound, p_bindings);
	if (!set) {
		return;
	}
	if (draw_list >= 0) {
		rd.draw_list_bind_uniform_set(draw_list, set, 0);
	} else {
		rd.compute_list_bind_uniform_set(compute_list, set, 0);
	}
}

void GodotDevice::push_constants(std::span<const uint8_t> p_bytes) {
	// Godot expects a multiple of 16 bytes; a C++ block may end with its last member, as in GLSL.
	const size_t padded_bytes = (p_bytes.size() + 15) / 16 * 16;
	GNOMON_ASSERT(padded_bytes == bound->push_constant_bytes && p_bytes.size() % 4 == 0,
			"pipeline '", bound->name, "': ", p_bytes.size(), " bytes of push constants, must be ",
			bound->push_constant_bytes);
	std::vector<uint8_t> bytes(p_bytes.begin(), p_bytes.end());
	bytes.resize(padded_bytes);
	const int64_t size = static_cast<int64_t>(bytes.size());
	if (draw_list >= 0) {
		rd.draw_list_set_push_constant(draw_list, PackedByteArray(bytes), size);
	} else {
		rd.compute_list_set_push_constant(compute_list, PackedByteArray(bytes), size);
	}
}

void GodotDevice::bind_vertex_buffers(std::span<const BufferRID> p_buffers) {
	vertex_buffers.assign(p_buffers.begin(), p_buffers.end());
}

void GodotDevice::bind_index_buffer(BufferRID p_buffer) {
	index_buffer = p_buffer;
}

void GodotDevice::bind_vertex_array(uint32_t p_vertex_count) {
	const auto &desc = std::get<RasterPipelineDesc>(bound->desc);
	if (desc.attributes.empty()) {
		return;
	}
	Key key = { p_vertex_count, static_cast<uint64_t>(bound->vertex_format) };
	Array sources; // one for each attribute
	for (const VertexAttribute &attribute : desc.attributes) {
		const godot::RID buffer = buffers.get(vertex_buffers[attribute.buffer_index]).rid;
		key.push_back(buffer.id);
		sources.append(Variant(buffer));
	}
	Cached &cached = vertex_arrays[key];
	if (!cached.rid) {
		cached.rid = rd.vertex_array_create(p_vertex_count, bound->vertex_format, sources, {});
		GNOMON_ASSERT(cached.rid, "pipeline '", bound->name, "': Godot refuses its vertices");
	}
	cached.last_use = submission;
	rd.draw_list_bind_vertex_array(draw_list, cached.rid);
}

void GodotDevice::draw(uint32_t p_vertex_count, uint32_t p_instance_count) {
	++counts.draws;
	const bool is_procedural = std::get<RasterPipelineDesc>(bound->desc).attributes.empty();
	bind_vertex_array(p_vertex_count);
	rd.draw_list_draw(draw_list, /*p_use_indices=*/false, p_instance_count,
			is_procedural ? p_vertex_count : 0);
}

void GodotDevice::draw_instances(
		uint32_t /*p_index_count*/, uint32_t /*p_instance_count*/, uint32_t /*p_first_instance*/) {
	GNOMON_ASSERT(false, "pipeline '", bound->name,
			"': draw_instances is not possible in Godot; use draw_indexed");
}

void GodotDevice::draw_indexed(uint32_t p_index_count, uint32_t p_first_index) {
	++counts.draws;
	const auto &desc = std::get<RasterPipelineDesc>(bound->desc);
	const BufferDesc &vertices = buffers.get(vertex_buffers[0]).desc;
	bind_vertex_array(static_cast<uint32_t>(vertices.size_bytes / desc.vertex_strides_bytes[0]));
	const godot::RID buffer = buffers.get(index_buffer).rid;
	Cached &cached = index_arrays[{ buffer.id, p_first_index, p_index_count }];
	if (!cached.rid) {
		cached.rid = rd.index_array_create(buffer, p_first_index, p_index_count);
		GNOMON_ASSERT(cached.rid, "pipeline '", bound->name, "': Godot refuses its indices");
	}
	cached.last_use = submission;
	rd.draw_list_bind_index_array(draw_list, cached.rid);
	rd.draw_list_draw(draw_list, /*p_use_indices=*/true, /*p_instances=*/1,
			/*p_procedural_vertex_count=*/0);
}

void GodotDevice::draw_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) {
	++counts.draws;
	rd.draw_list_draw_indirect(draw_list, /*p_use_indices=*/false, buffers.get(p_arguments).rid,
			static_cast<int64_t>(p_offset_bytes), /*p_draw_count=*/1, /*p_stride=*/0);
}

void GodotDevice::dispatch(glm::uvec3 p_group_count) {
	++counts.dispatches;
	rd.compute_list_dispatch(compute_list, p_group_count.x, p_group_count.y, p_group_count.z);
}

void GodotDevice::dispatch_items(glm::uvec3 p_item_count) {
	dispatch(arrange_work_groups((p_item_count + bound->local_size - 1u) / bound->local_size));
}

void GodotDevice::dispatch_indirect(BufferRID p_arguments, uint64_t p_offset_bytes) {
	++counts.dispatches;
	rd.compute_list_dispatch_indirect(
			compute_list, buffers.get(p_arguments).rid, static_cast<int64_t>(p_offset_bytes));
}

void GodotDevice::clear_buffer(BufferRID p_buffer) {
	end_compute_list();
	const GodotBuffer &buffer = buffers.get(p_buffer);
	rd.buffer_clear(buffer.rid, 0, static_cast<int64_t>(buffer.desc.size_bytes));
}

void GodotDevice::copy_buffer(BufferRID p_source, BufferRID p_target, uint64_t p_size_bytes,
		uint64_t p_source_offset_bytes, uint64_t p_target_offset_bytes) {
	end_compute_list();
	flush_uploads();
	GodotBuffer &target = buffers.get(p_target);
	const godot::RID source = buffers.get(p_source).rid;
	if (target.desc.memory != MemoryKind::READBACK) {
		rd.buffer_copy(source, target.rid, static_cast<int64_t>(p_source_offset_bytes),
				static_cast<int64_t>(p_target_offset_bytes), static_cast<int64_t>(p_size_bytes));
		return;
	}
	// Waits for the GPU.
	const PackedByteArray read = rd.buffer_get_data(source,
			static_cast<int64_t>(p_source_offset_bytes), static_cast<int64_t>(p_size_bytes));
	std::memcpy(
			target.bytes.data() + p_target_offset_bytes, read.get_values().data(), p_size_bytes);
}

void GodotDevice::copy_texture_to_buffer(
		TextureRID p_source, BufferRID p_target, uint32_t p_layer) {
	end_compute_list();
	GodotBuffer &target = buffers.get(p_target);
	GNOMON_ASSERT(target.desc.memory == MemoryKind::READBACK, "buffer '", target.desc.name,
			"': Godot copies textures to READBACK buffers only");
	const PackedByteArray read = rd.texture_get_data(textures.get(p_source).rid, p_layer);
	const std::span<const uint8_t> bytes = read.get_values();
	std::memcpy(target.bytes.data(), bytes.data(), std::min(bytes.size(), target.bytes.size()));
}

void GodotDevice::copy_buffer_to_texture(
		BufferRID p_source, TextureRID p_target, uint32_t p_layer, uint64_t p_source_offset_bytes) {
	const GodotBuffer &source = buffers.get(p_source);
	const GodotTexture &target = textures.get(p_target);
	GNOMON_ASSERT(source.desc.memory == MemoryKind::UPLOAD, "buffer '", source.desc.name,
			"': Godot copies to textures from UPLOAD buffers only");
	end_compute_list();
	const uint64_t size_bytes = uint64_t(target.desc.size_px.x) * target.desc.size_px.y *
			get_texel_size_bytes(target.desc.format);
	rd.texture_update(target.rid, p_layer,
			PackedByteArray(std::span(source.bytes)
									.subspan(size_t(p_source_offset_bytes), size_t(size_bytes))));
}

void GodotDevice::copy_texture(TextureRID p_source, TextureRID p_target) {
	end_compute_list();
	const GodotTexture &source = textures.get(p_source);
	const glm::vec3 size(glm::vec2(source.desc.size_px), 1.0f);
	rd.texture_copy(source.rid, textures.get(p_target).rid, glm::vec3(0.0f), glm::vec3(0.0f), size,
			/*p_src_mipmap=*/0, /*p_dst_mipmap=*/0, /*p_src_layer=*/0, /*p_dst_layer=*/0);
}

void GodotDevice::clear_color(TextureRID p_texture, glm::vec4 p_value, uint32_t p_layer) {
	end_compute_list();
	const GodotTexture &texture = textures.get(p_texture);
	const bool is_one = p_layer != Binding::ALL_LAYERS;
	rd.texture_clear(texture.rid, to_godot_clear_value(texture.desc.format, p_value),
			/*p_base_mipmap=*/0, /*p_mipmap_count=*/1, is_one ? p_layer : 0,
			is_one ? 1 : texture.desc.layer_count);
}

void GodotDevice::read_back(BufferRID p_buffer, ReadBackCallback p_callback) {
	if (is_compiling_only) {
		return; // the commands that write it are not executed
	}
	end_compute_list();
	const GodotBuffer &buffer = buffers.get(p_buffer);
	const int64_t size = static_cast<int64_t>(buffer.desc.size_bytes);
	if (kind == Kind::MAIN) {
		rd.buffer_get_data_async(buffer.rid, make_callable(std::move(p_callback)), 0, size);
		return;
	}
	add_read_back(rd.buffer_get_data(buffer.rid, 0, size).get_values(), std::move(p_callback));
}

void GodotDevice::read_back(TextureRID p_texture, uint32_t p_layer, ReadBackCallback p_callback) {
	if (is_compiling_only) {
		return; // the commands that write it are not executed
	}
	end_compute_list();
	const godot::RID texture = textures.get(p_texture).rid;
	if (kind == Kind::MAIN) {
		rd.texture_get_data_async(texture, p_layer, make_callable(std::move(p_callback)));
		return;
	}
	add_read_back(rd.texture_get_data(texture, p_layer).get_values(), std::move(p_callback));
}

void GodotDevice::add_read_back(std::span<const uint8_t> p_bytes, ReadBackCallback &&p_callback) {
	read_backs.emplace_back(
			std::vector<uint8_t>(p_bytes.begin(), p_bytes.end()), std::move(p_callback));
}

void GodotDevice::call_read_backs() {
	while (!read_backs.empty()) {
		const auto [bytes, callback] = std::move(read_backs.front());
		read_backs.pop_front(); // first: the callback may throw
		callback(bytes);
	}
}

} // namespace gnomon
