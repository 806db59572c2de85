#pragma once

#include "modules/renderer/gbuffer.h"
#include "modules/shadows/shadow_frame.h"

namespace gnomon {

/// Computes the exposure at which a white surface at the centre of the bounds of all instances,
/// facing the brightest light, has an exposed radiance of 0.8. The intensities may have any unit.
/// Returns 1 without lights or meshes.
float compute_exposure(const SceneSnapshot &p_scene, const Bounds &p_bounds_world);

/// The data that all passes of one image use.
struct LitImage {
	RenderGraph &graph;
	RenderingDevice &device;
	GBuffer gbuffer;
	RGBuffer frame;						// FrameConstants
	glm::uvec2 size_px = glm::uvec2(0); // drawn size: antialiasing times that of the output image
	uint32_t antialiasing = 1;			// drawn texels per output pixel along each axis
	float exposure = 1.0f;
};

/// Draws ambient and emitted light, exposed, as RGBA16_SFLOAT.
RGTexture add_ambient_pass(const LitImage &p_image);
/// Adds one light's contribution, multiplied by its mask.
void add_lighting_pass(const LitImage &p_image, const LightShadow &p_shadow, RGTexture p_radiance);
/// Creates the image that is shown or captured: RGBA8_UNORM, sRGB-encoded.
RGTexture create_output_image(RenderGraph &r_graph, glm::uvec2 p_size_px);
/// Tone-maps the radiance into a new output image, with the texels of each pixel averaged, and
/// returns it.
RGTexture add_tone_map_pass(const LitImage &p_image, RGTexture p_radiance);

} // namespace gnomon
