#include "modules/renderer/lighting.h"

#include "modules/render_graph/compute_pass.h"

#include "renderer/renderer_shared.h"

namespace gnomon {

shader::LightConstants compute_light_constants(
		const LightSnapshot &p_light, const CameraSnapshot &p_camera) {
	shader::LightConstants constants = {};
	const glm::dvec3 position = p_light.type == LightType::DIRECTIONAL
			? glm::dvec3(0.0)
			: p_light.position_world - p_camera.position_world;
	constants.position_radius = glm::vec4(glm::vec3(position), p_light.get_disc_radius());
	constants.direction = glm::vec4(glm::vec3(p_light.get_direction_world()), 0.0f);
	constants.intensity = glm::vec4(p_light.color * p_light.intensity, 0.0f);
	constants.range_m = p_light.range_m;
	constants.cos_outer = std::cos(p_light.outer_cone_rad);
	constants.cos_inner = std::cos(p_light.inner_cone_rad);
	constants.type = p_light.type == LightType::OMNI ? LIGHT_TYPE_OMNI
			: p_light.type == LightType::SPOT		 ? LIGHT_TYPE_SPOT
													 : LIGHT_TYPE_DIRECTIONAL;
	constants.outer_width_m = p_light.penumbra_outer_width_m;
	constants.inner_width_m = p_light.penumbra_inner_width_m;
	constants.casts_shadow = p_light.casts_shadow ? 1u : 0u;
	return constants;
}

RGTexture add_receivers_pass(RenderGraph &r_graph, RenderingDevice &p_device,
		const GBuffer &p_gbuffer, RGBuffer p_frame, RGBuffer p_light, glm::uvec2 p_size_px) {
	const PipelineRID pipeline =
			p_device.get_compute_pipeline({ "receivers", "renderer/receivers.comp", {} });
	const RGTexture receivers = r_graph.create_texture({ "receivers", Format::R8_UNORM, p_size_px,
			1, TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	add_compute_pass(r_graph, "receivers", pipeline,
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_frame),
					PassBinding::constants(RENDERER_BINDING_LIGHT, p_light),
					PassBinding::read(RENDERER_BINDING_DEPTH, p_gbuffer.depth),
					PassBinding::read(
							RENDERER_BINDING_GEOMETRIC_NORMAL, p_gbuffer.geometric_normal),
					PassBinding::write(RENDERER_BINDING_RECEIVERS, receivers),
			},
			glm::uvec3(p_size_px, 1u));
	return receivers;
}

RGTexture add_constant_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, float p_visibility) {
	const RGTexture mask = r_graph.create_texture({ "constant mask", Format::R16_SFLOAT, p_size_px,
			1, TextureUsage::COPY_TARGET | TextureUsage::SAMPLED | TextureUsage::COPY_SOURCE });
	r_graph.add_pass("constant mask")
			.writes(mask, Access::COPY_WRITE)
			.execute([=](PassContext &p_context) {
				p_context.commands.clear_color(p_context.get(mask), glm::vec4(p_visibility));
			});
	return mask;
}

bool is_colored_mask(const RenderGraph &p_graph, RGTexture p_mask) {
	const Format format = p_graph.get_desc(p_mask).format;
	return format == Format::RGBA16_SFLOAT || format == Format::RGBA32_SFLOAT;
}

std::vector<SpecializationConstant> make_mask_constants(
		const RenderGraph &p_graph, RGTexture p_mask) {
	return { { RENDERER_CONSTANT_IS_COLORED, is_colored_mask(p_graph, p_mask) ? 1u : 0u } };
}

RGTexture add_ambient_pass(RenderGraph &r_graph, RenderingDevice &p_device,
		const GBuffer &p_gbuffer, RGBuffer p_frame, glm::uvec2 p_size_px) {
	const PipelineRID pipeline =
			p_device.get_compute_pipeline({ "ambient", "renderer/ambient.comp", {} });
	const RGTexture radiance = r_graph.create_texture({ "radiance", Format::RGBA16_SFLOAT,
			p_size_px, 1, TextureUsage::STORAGE | TextureUsage::SAMPLED });
	add_compute_pass(r_graph, "ambient", pipeline,
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_frame),
					PassBinding::read(RENDERER_BINDING_DEPTH, p_gbuffer.depth),
					PassBinding::read(RENDERER_BINDING_BASE_COLOR, p_gbuffer.base_color),
					PassBinding::read(RENDERER_BINDING_EMISSIVE, p_gbuffer.emissive),
					PassBinding::write(RENDERER_BINDING_RADIANCE, radiance),
			},
			glm::uvec3(p_size_px, 1u));
	return radiance;
}

void add_lighting_pass(RenderGraph &r_graph, RenderingDevice &p_device, const GBuffer &p_gbuffer,
		RGBuffer p_frame, RGBuffer p_light, RGTexture p_receivers, RGTexture p_mask,
		RGTexture p_radiance, glm::uvec2 p_size_px) {
	const PipelineRID pipeline = p_device.get_compute_pipeline(
			{ "lighting", "renderer/lighting.comp", make_mask_constants(r_graph, p_mask) });
	add_compute_pass(r_graph, "lighting", pipeline,
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_frame),
					PassBinding::constants(RENDERER_BINDING_LIGHT, p_light),
					PassBinding::read(RENDERER_BINDING_DEPTH, p_gbuffer.depth),
					PassBinding::read(RENDERER_BINDING_SHADING_NORMAL, p_gbuffer.shading_normal),
					PassBinding::read(RENDERER_BINDING_MATERIAL, p_gbuffer.material),
					PassBinding::read(RENDERER_BINDING_BASE_COLOR, p_gbuffer.base_color),
					PassBinding::read(RENDERER_BINDING_RECEIVERS, p_receivers),
					PassBinding::read(RENDERER_BINDING_MASK, p_mask),
					PassBinding::write(
							RENDERER_BINDING_RADIANCE, p_radiance, PassBuilder::Content::UPDATE),
			},
			glm::uvec3(p_size_px, 1u));
}

RGTexture create_picture(RenderGraph &r_graph, glm::uvec2 p_size_px) {
	return r_graph.create_texture({ "picture", Format::RGBA8_UNORM, p_size_px, 1,
			TextureUsage::STORAGE | TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE });
}

RGTexture add_tone_map_pass(RenderGraph &r_graph, RenderingDevice &p_device, RGBuffer p_frame,
		RGTexture p_radiance, glm::uvec2 p_size_px) {
	const PipelineRID pipeline =
			p_device.get_compute_pipeline({ "tone map", "renderer/tone_map.comp", {} });
	const RGTexture output = create_picture(r_graph, p_size_px);
	add_compute_pass(r_graph, "tone map", pipeline,
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_frame),
					PassBinding::read(RENDERER_BINDING_RADIANCE, p_radiance),
					PassBinding::write(RENDERER_BINDING_OUTPUT, output),
			},
			glm::uvec3(p_size_px, 1u));
	return output;
}

} // namespace gnomon
