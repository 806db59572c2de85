#include "modules/renderer/lighting.h"

#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/mask.h"

#include "renderer/renderer_shared.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

// Exposed radiance of a white surface: in ambient light, enough to see shapes in the umbra, and
// facing the brightest light.
constexpr float EXPOSED_AMBIENT = 0.06f;
constexpr float EXPOSED_WHITE = 0.8f;

/// Illuminance of a surface that faces the light, in lx if the intensity is in cd or lx. The range
/// and the cone are ignored.
float compute_light_illuminance(const LightSnapshot &p_light, const glm::dvec3 &p_position_world) {
	const float brightest = std::max({ p_light.color.x, p_light.color.y, p_light.color.z });
	const float intensity = p_light.intensity * brightest;
	if (p_light.type == LightType::DIRECTIONAL) {
		return intensity;
	}
	const glm::dvec3 to_light = p_light.position_world - p_position_world;
	// At least (1 mm)^2, for a light at the position.
	return static_cast<float>(intensity / std::max(glm::dot(to_light, to_light), 1e-6));
}

shader::ExposurePush make_exposure(const LitImage &p_image) {
	return { glm::vec4(glm::vec3(EXPOSED_AMBIENT / p_image.exposure), p_image.exposure) };
}

} // namespace

float compute_exposure(const SceneSnapshot &p_scene, const Bounds &p_bounds_world) {
	float brightest = 0;
	if (!p_bounds_world.is_empty()) {
		const glm::dvec3 centre = 0.5 * (p_bounds_world.minimum + p_bounds_world.maximum);
		for (const LightSnapshot &light : p_scene.lights) {
			brightest = std::max(brightest, compute_light_illuminance(light, centre));
		}
	}
	// A white Lambertian surface has the radiance illuminance / pi.
	return brightest > 0 && std::isfinite(brightest) ? EXPOSED_WHITE * 3.14159265f / brightest
													 : 1.0f;
}

RGTexture add_ambient_pass(const LitImage &p_image) {
	const RGTexture radiance = p_image.graph.create_texture({ "radiance", Format::RGBA16_SFLOAT,
			p_image.size_px, 1, TextureUsage::STORAGE | TextureUsage::SAMPLED });
	add_compute_pass(p_image.graph, "ambient",
			p_image.device.get_compute_pipeline({ "ambient", "renderer/ambient.comp", {} }),
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_image.frame),
					PassBinding::read(RENDERER_BINDING_DEPTH, p_image.gbuffer.depth),
					PassBinding::read(RENDERER_BINDING_BASE_COLOR, p_image.gbuffer.base_color),
					PassBinding::read(RENDERER_BINDING_EMISSIVE, p_image.gbuffer.emissive),
					PassBinding::write(RENDERER_BINDING_RADIANCE, radiance),
			},
			p_image.size_px, make_exposure(p_image));
	return radiance;
}

void add_lighting_pass(const LitImage &p_image, const LightShadow &p_shadow, RGTexture p_radiance) {
	const GBuffer &gbuffer = p_image.gbuffer;
	add_tile_pass(p_image.graph, "lighting",
			p_image.device.get_compute_pipeline({ "lighting", "renderer/lighting.comp",
					make_mask_constants(p_image.graph, p_shadow.mask) }),
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_image.frame),
					PassBinding::constants(RENDERER_BINDING_LIGHT, p_shadow.light_constants),
					PassBinding::read(RENDERER_BINDING_DEPTH, gbuffer.depth),
					PassBinding::read(RENDERER_BINDING_SHADING_NORMAL, gbuffer.shading_normal),
					PassBinding::read(RENDERER_BINDING_MATERIAL, gbuffer.material),
					PassBinding::read(RENDERER_BINDING_BASE_COLOR, gbuffer.base_color),
					PassBinding::read(RENDERER_BINDING_RECEIVERS, p_shadow.receivers),
					PassBinding::read(RENDERER_BINDING_MASK, p_shadow.mask),
					PassBinding::write(
							RENDERER_BINDING_RADIANCE, p_radiance, PassBuilder::Content::UPDATE),
			},
			p_shadow.tiles, RENDERER_BINDING_TILES, make_push_bytes(make_exposure(p_image)));
}

RGTexture create_output_image(RenderGraph &r_graph, glm::uvec2 p_size_px) {
	return r_graph.create_texture({ "image", Format::RGBA8_UNORM, p_size_px, 1,
			TextureUsage::STORAGE | TextureUsage::SAMPLED | TextureUsage::COLOR_ATTACHMENT |
					TextureUsage::COPY_SOURCE });
}

RGTexture add_tone_map_pass(const LitImage &p_image, RGTexture p_radiance) {
	const glm::uvec2 size_px = p_image.size_px / p_image.antialiasing;
	const RGTexture output = create_output_image(p_image.graph, size_px);
	add_compute_pass(p_image.graph, "tone map",
			p_image.device.get_compute_pipeline({ "tone map", "renderer/tone_map.comp", {} }),
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_image.frame),
					PassBinding::read(RENDERER_BINDING_RADIANCE, p_radiance),
					PassBinding::write(RENDERER_BINDING_OUTPUT, output),
			},
			size_px, shader::ToneMapPush{ .antialiasing = p_image.antialiasing });
	return output;
}

} // namespace gnomon
