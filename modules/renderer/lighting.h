#pragma once

#include "modules/renderer/gbuffer.h"
#include "modules/renderer/shadow_technique.h"

#include "shared/light_shared.h"

namespace gnomon {

/// The light in camera-relative space, as the shaders read it.
shader::LightConstants compute_light_constants(
		const LightSnapshot &p_light, const CameraSnapshot &p_camera);

/// R8_UNORM: 1 where the light can reach (TECHNIQUES, section 0: receiver pixels).
RGTexture add_receivers_pass(RenderGraph &r_graph, RenderingDevice &p_device,
		const GBuffer &p_gbuffer, RGBuffer p_frame, RGBuffer p_light, glm::uvec2 p_size_px);

/// A mask of one value; for lights without a shadow.
RGTexture add_constant_mask(RenderGraph &r_graph, glm::uvec2 p_size_px, float p_visibility);

/// Has the mask a value for each colour? A technique's has one; behind translucent casters it has
/// three.
bool is_colored_mask(const RenderGraph &p_graph, RGTexture p_mask);
/// RENDERER_CONSTANT_IS_COLORED of shaders that read a mask.
std::vector<SpecializationConstant> make_mask_constants(
		const RenderGraph &p_graph, RGTexture p_mask);

/// RGBA16_SFLOAT, exposed: ambient and emitted light.
RGTexture add_ambient_pass(RenderGraph &r_graph, RenderingDevice &p_device,
		const GBuffer &p_gbuffer, RGBuffer p_frame, glm::uvec2 p_size_px);
/// Adds one light, times its mask.
void add_lighting_pass(RenderGraph &r_graph, RenderingDevice &p_device, const GBuffer &p_gbuffer,
		RGBuffer p_frame, RGBuffer p_light, RGTexture p_receivers, RGTexture p_mask,
		RGTexture p_radiance, glm::uvec2 p_size_px);
/// What is shown or captured: RGBA8_UNORM, sRGB-encoded.
RGTexture create_picture(RenderGraph &r_graph, glm::uvec2 p_size_px);
/// Fills one.
RGTexture add_tone_map_pass(RenderGraph &r_graph, RenderingDevice &p_device, RGBuffer p_frame,
		RGTexture p_radiance, glm::uvec2 p_size_px);

} // namespace gnomon
