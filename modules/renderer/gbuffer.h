#pragma once

#include "modules/render_graph/render_graph.h"
#include "modules/renderer/light_view.h"
#include "modules/renderer/mesh_store.h"
#include "modules/renderer/truth_source.h"
#include "modules/scene/scene_snapshot.h"

#include "shared/frame_shared.h"

namespace gnomon {

/// What the camera sees, one texel per pixel.
struct GBuffer {
	RGTexture depth;			// D32_SFLOAT, reversed
	RGTexture base_color;		// RGBA8_SRGB
	RGTexture geometric_normal; // R32_UINT
	RGTexture shading_normal;	// R32_UINT
	RGTexture material;			// RGBA16_SFLOAT: s, scatter_distance_m, roughness
								// (-1 - roughness for Phong's model), metallic
	RGTexture emissive;			// RGBA16_SFLOAT, cd/m^2
};

/// The camera as the shaders read it. Exposure and ambient: see compute_exposure.
shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);

/// A pixel's point relative to the camera, from its reversed depth (above 0): position_from_depth
/// of depth_inc.glsl, for passes that run on the CPU.
glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth);

/// The texels of a G-buffer's textures of those names, on the CPU, rows from the top.
struct GBufferTexels {
	const uint8_t *depth = nullptr;
	const uint8_t *geometric_normal = nullptr;
	const uint8_t *material = nullptr;
};
/// What the camera sees in each pixel, for passes that run on the CPU.
std::vector<SurfacePoint> read_surfaces(
		const shader::FrameConstants &p_frame, glm::uvec2 p_size_px, const GBufferTexels &p_texels);

/// Scales radiance so that a white surface at the middle of the casters, facing the brightest
/// light, shows at about 0.8, whatever unit the file's intensities are in. 1 without lights.
float compute_exposure(const SceneSnapshot &p_scene);

/// Draws the instances the camera may see. r_drawn_count: how many those are.
GBuffer add_gbuffer_pass(RenderGraph &r_graph, RenderingDevice &p_device, MeshStore &p_meshes,
		const SceneSnapshot &p_scene, glm::uvec2 p_size_px, RGBuffer p_frame,
		uint32_t &r_drawn_count);

/// The camera as a view, for culling: its sides and what lies behind it.
LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px);

} // namespace gnomon
