// Shaders and pipelines of GodotDevice.

#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/rendering_device_godot/godot_device.h"
#include "modules/rendering_device_godot/godot_formats.h"

#include <algorithm>

namespace gnomon {

using RD = godot::RenderingDevice;
using godot::Array;
using godot::PackedByteArray;
using godot::Ref;
using godot::Variant;

namespace {

int64_t to_godot_stage(ShaderStage p_stage, const std::string &p_name) {
	switch (p_stage) {
		case ShaderStage::VERTEX:
			return RD::SHADER_STAGE_VERTEX;
		case ShaderStage::FRAGMENT:
			return RD::SHADER_STAGE_FRAGMENT;
		case ShaderStage::COMPUTE:
			return RD::SHADER_STAGE_COMPUTE;
		case ShaderStage::GEOMETRY:
		case ShaderStage::NONE:
			break;
	}
	GNOMON_ASSERT(false, "shader ", p_name, " is not a vertex, fragment or compute shader");
	return 0;
}

Array make_constants(
		const GodotPipeline &p_pipeline, const std::vector<SpecializationConstant> &p_constants) {
	Array constants;
	for (const SpecializationConstant &constant : p_constants) {
		const auto &booleans = p_pipeline.boolean_constants;
		const bool is_boolean =
				std::find(booleans.begin(), booleans.end(), constant.constant_id) != booleans.end();
		const auto made = Ref<godot::RDPipelineSpecializationConstant>::create();
		made.set_constant_id(constant.constant_id);
		// Godot needs the value in the constant's type, boolean or integer.
		made.set_value(
				is_boolean ? Variant(constant.value != 0) : Variant(int64_t(constant.value)));
		constants.append(Variant::of_object(made.get_object()));
	}
	return constants;
}

void set_stencil(const StencilTest &p_test, const godot::RDPipelineDepthStencilState &r_state) {
	constexpr int64_t ALL_BITS = 0xff; // of an 8-bit stencil
	// Gnomon's and Godot's enums have the same order.
	r_state.set_enable_stencil(true);
	r_state.set_front_op_compare(int64_t(p_test.front.compare));
	r_state.set_front_op_fail(int64_t(p_test.front.fail));
	r_state.set_front_op_depth_fail(int64_t(p_test.front.depth_fail));
	r_state.set_front_op_pass(int64_t(p_test.front.pass));
	r_state.set_front_op_reference(p_test.reference);
	r_state.set_front_op_compare_mask(ALL_BITS);
	r_state.set_front_op_write_mask(ALL_BITS);
	r_state.set_back_op_compare(int64_t(p_test.back.compare));
	r_state.set_back_op_fail(int64_t(p_test.back.fail));
	r_state.set_back_op_depth_fail(int64_t(p_test.back.depth_fail));
	r_state.set_back_op_pass(int64_t(p_test.back.pass));
	r_state.set_back_op_reference(p_test.reference);
	r_state.set_back_op_compare_mask(ALL_BITS);
	r_state.set_back_op_write_mask(ALL_BITS);
}
static_assert(int64_t(CompareOp::ALWAYS) == RD::COMPARE_OP_ALWAYS &&
		int64_t(CompareOp::GREATER) == RD::COMPARE_OP_GREATER &&
		int64_t(StencilOp::DECREMENT_WRAP) == RD::STENCIL_OP_DECREMENT_AND_WRAP);

Ref<godot::RDPipelineColorBlendStateAttachment> make_blend(BlendMode p_mode) {
	const auto state = Ref<godot::RDPipelineColorBlendStateAttachment>::create();
	if (p_mode == BlendMode::OFF) {
		return state;
	}
	const bool is_alpha = p_mode == BlendMode::ALPHA;
	const int64_t operation = p_mode == BlendMode::MINIMUM ? RD::BLEND_OP_MINIMUM
			: p_mode == BlendMode::MAXIMUM				   ? RD::BLEND_OP_MAXIMUM
														   : RD::BLEND_OP_ADD;
	const int64_t dst_factor =
			is_alpha ? RD::BLEND_FACTOR_ONE_MINUS_SRC_ALPHA : RD::BLEND_FACTOR_ONE;
	state.set_enable_blend(true);
	state.set_src_color_blend_factor(is_alpha ? RD::BLEND_FACTOR_SRC_ALPHA : RD::BLEND_FACTOR_ONE);
	state.set_dst_color_blend_factor(dst_factor);
	state.set_color_blend_op(operation);
	state.set_src_alpha_blend_factor(RD::BLEND_FACTOR_ONE);
	state.set_dst_alpha_blend_factor(dst_factor);
	state.set_alpha_blend_op(operation);
	return state;
}

int64_t to_godot_cull_mode(CullMode p_mode) {
	return p_mode == CullMode::NONE	   ? RD::POLYGON_CULL_DISABLED
			: p_mode == CullMode::BACK ? RD::POLYGON_CULL_BACK
									   : RD::POLYGON_CULL_FRONT;
}

} // namespace

godot::RID GodotDevice::get_shader(std::span<const std::string> p_names) {
	godot::RID &shader = shaders[{ p_names.begin(), p_names.end() }];
	if (shader) {
		return shader;
	}
	const auto spirv = Ref<godot::RDShaderSPIRV>::create();
	for (const std::string &name : p_names) {
		const std::span<const uint32_t> words = find_embedded_shader(name);
		const ShaderStage stage = reflect_spirv(name, words, {}).stage;
		spirv.set_stage_bytecode(to_godot_stage(stage, name),
				PackedByteArray(std::span(
						reinterpret_cast<const uint8_t *>(words.data()), words.size_bytes())));
	}
	shader = rd.shader_create_from_spirv(spirv, p_names.back());
	if (!shader) {
		fail("Shader \"", p_names.back(),
				"\" is refused by Godot: its log has the reason. Build the "
				"add-on again, or set another shadow technique.");
	}
	return shader;
}

PipelineRID GodotDevice::add_pipeline(
		GodotPipeline &&p_pipeline, std::span<const std::string> p_shaders) {
	p_pipeline.shader_names.assign(p_shaders.begin(), p_shaders.end());
	const auto &constants = std::visit(
			[](const auto &p_desc) -> const std::vector<SpecializationConstant> & {
				return p_desc.constants;
			},
			p_pipeline.desc);
	std::vector<ReflectedShader> reflected;
	for (const std::string &name : p_shaders) {
		reflected.push_back(reflect_spirv(name, find_embedded_shader(name), constants));
		const auto &booleans = reflected.back().boolean_constants;
		p_pipeline.boolean_constants.insert(
				p_pipeline.boolean_constants.end(), booleans.begin(), booleans.end());
	}
	p_pipeline.bindings = merge_bindings(p_pipeline.name, reflected);
	p_pipeline.push_constant_bytes = compute_push_constant_bytes(reflected);
	p_pipeline.local_size = reflected[0].local_size;
	pipelines.push_back(std::move(p_pipeline));
	return { pipelines.size() };
}

size_t GodotDevice::get_index(PipelineRID p_pipeline) const {
	GNOMON_ASSERT(p_pipeline.id >= 1 && p_pipeline.id <= pipelines.size(), "pipeline handle ",
			p_pipeline.id);
	return p_pipeline.id - 1;
}

PipelineRID GodotDevice::get_compute_pipeline(const ComputePipelineDesc &p_desc) {
	const auto found = compute_pipelines.find(p_desc);
	if (found != compute_pipelines.end()) {
		return found->second;
	}
	GodotPipeline pipeline;
	pipeline.name = p_desc.name.empty() ? p_desc.shader : p_desc.name;
	pipeline.desc = p_desc;
	return compute_pipelines[p_desc] = add_pipeline(std::move(pipeline), { &p_desc.shader, 1 });
}

godot::RID GodotDevice::compile(GodotPipeline &r_pipeline, int64_t p_framebuffer_format) {
	const auto found = r_pipeline.by_framebuffer_format.find(p_framebuffer_format);
	if (found != r_pipeline.by_framebuffer_format.end()) {
		return found->second;
	}
	r_pipeline.shader = get_shader(r_pipeline.shader_names);
	const auto *compute = std::get_if<ComputePipelineDesc>(&r_pipeline.desc);
	const godot::RID made = compute ? rd.compute_pipeline_create(r_pipeline.shader,
											  make_constants(r_pipeline, compute->constants))
									: make_raster_pipeline(r_pipeline, p_framebuffer_format);
	if (!made) {
		fail("Pipeline '", r_pipeline.name,
				"' is refused by Godot: its log has the reason. Set another shadow technique.");
	}
	return r_pipeline.by_framebuffer_format[p_framebuffer_format] = made;
}

PipelineRID GodotDevice::get_raster_pipeline(const RasterPipelineDesc &p_desc) {
	const auto found = raster_pipelines.find(p_desc);
	if (found != raster_pipelines.end()) {
		return found->second;
	}
	if (!p_desc.geometry_shader.empty() || p_desc.has_depth_bounds) {
		fail("Pipeline '", p_desc.name, "' needs ",
				p_desc.has_depth_bounds ? "depth bounds" : "geometry shaders",
				", which Godot's device lacks. Choose another method.");
	}
	GodotPipeline pipeline;
	pipeline.name = p_desc.name;
	pipeline.desc = p_desc;
	if (!p_desc.attributes.empty()) {
		Key key;
		Array attributes;
		for (const VertexAttribute &attribute : p_desc.attributes) {
			const uint32_t stride = p_desc.vertex_strides_bytes[attribute.buffer_index];
			const auto made = Ref<godot::RDVertexAttribute>::create();
			made.set_location(attribute.location);
			made.set_offset(attribute.offset_bytes);
			made.set_format(to_godot_vertex_format(attribute.component_count));
			made.set_stride(stride);
			attributes.append(Variant::of_object(made.get_object()));
			key.insert(key.end(),
					{ attribute.location, attribute.offset_bytes, attribute.component_count,
							stride });
		}
		const auto cached_format = vertex_formats.find(key);
		pipeline.vertex_format = cached_format != vertex_formats.end()
				? cached_format->second
				: (vertex_formats[key] = rd.vertex_format_create(attributes));
	}
	std::vector<std::string> names = { p_desc.vertex_shader };
	if (!p_desc.fragment_shader.empty()) {
		names.push_back(p_desc.fragment_shader);
	}
	return raster_pipelines[p_desc] = add_pipeline(std::move(pipeline), names);
}

godot::RID GodotDevice::make_raster_pipeline(
		const GodotPipeline &p_pipeline, int64_t p_framebuffer_format) {
	const auto &desc = std::get<RasterPipelineDesc>(p_pipeline.desc);
	const auto rasterization = Ref<godot::RDPipelineRasterizationState>::create();
	rasterization.set_cull_mode(to_godot_cull_mode(desc.cull_mode));
	rasterization.set_front_face(desc.winding == Winding::NORMAL
					? RD::POLYGON_FRONT_FACE_COUNTER_CLOCKWISE
					: RD::POLYGON_FRONT_FACE_CLOCKWISE);
	rasterization.set_enable_depth_clamp(desc.clamps_depth);
	rasterization.set_depth_bias_enabled(
			desc.depth_bias_constant != 0.0f || desc.depth_bias_slope != 0.0f);
	rasterization.set_depth_bias_constant_factor(double(desc.depth_bias_constant));
	rasterization.set_depth_bias_slope_factor(double(desc.depth_bias_slope));
	const auto depth_stencil = Ref<godot::RDPipelineDepthStencilState>::create();
	depth_stencil.set_enable_depth_test(desc.has_depth);
	depth_stencil.set_enable_depth_write(desc.has_depth && desc.writes_depth);
	depth_stencil.set_depth_compare_operator(int64_t(desc.depth_compare));
	if (desc.has_stencil) {
		set_stencil(desc.stencil, depth_stencil);
	}
	const auto blend = Ref<godot::RDPipelineColorBlendState>::create();
	Array attachments;
	for (const Format format : desc.color_formats) {
		const auto attachment = make_blend(is_uint_format(format) ? BlendMode::OFF : desc.blend);
		attachments.append(Variant::of_object(attachment.get_object()));
	}
	blend.set_attachments(attachments);
	return rd.render_pipeline_create(p_pipeline.shader, p_framebuffer_format,
			p_pipeline.vertex_format, RD::RENDER_PRIMITIVE_TRIANGLES, rasterization,
			Ref<godot::RDPipelineMultisampleState>::create(), depth_stencil, blend,
			/*p_dynamic_state_flags=*/0, /*p_for_render_pass=*/0,
			make_constants(p_pipeline, desc.constants));
}

void GodotDevice::replace_shaders(const std::map<std::string, std::vector<uint32_t>> &) {
	fail("Shaders cannot be replaced inside Godot. Edit them with the editor of Gnomon.");
}

} // namespace gnomon
