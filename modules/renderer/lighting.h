#pragma once

#include "modules/renderer/gbuffer.h"
#include "modules/shadows/shadow_frame.h"

namespace gnomon {

/// Scales radiance so that a white surface at the middle of the casters, facing the brightest
/// light, shows at about 0.8, whatever unit the file's intensities are in. 1 without lights.
float compute_exposure(const SceneSnapshot &p_scene);

/// What the passes of one image have in common.
struct LitImage {
	RenderGraph &graph;
	RenderingDevice &device;
	GBuffer gbuffer;
	RGBuffer frame;						// FrameConstants
	glm::uvec2 size_px = glm::uvec2(0); // as it is drawn
	uint32_t antialiasing = 1;			// so many texels a side make a pixel
	float exposure = 1.0f;
};

/// RGBA16_SFLOAT, exposed: ambient and emitted light.
RGTexture add_ambient_pass(const LitImage &p_image);
/// Adds one light, times its mask.
void add_lighting_pass(const LitImage &p_image, const LightShadow &p_shadow, RGTexture p_radiance);
/// What is shown or captured: RGBA8_UNORM, sRGB-encoded.
RGTexture create_output_image(RenderGraph &r_graph, glm::uvec2 p_size_px);
/// Fills one.
RGTexture add_tone_map_pass(const LitImage &p_image, RGTexture p_radiance);

} // namespace gnomon
