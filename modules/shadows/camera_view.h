#pragma once

#include "modules/shadows/light_view.h"

#include "shared/frame_shared.h"

namespace gnomon {

/// Describes the camera as a view, for clip-space matrices and for culling (against the four sides
/// of its frustum and the plane z = 0). Ignores the subpixel shift (CameraSnapshot::shift).
LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px);
/// The same, so wide that it contains the shifted view.
LightView make_shifted_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px);

/// Clip-space matrix that applies the camera's subpixel shift (CameraSnapshot::shift). It expects w
/// to be the distance along the view, as a perspective projection makes it.
glm::dmat4 compute_shift(const CameraSnapshot &p_camera);

// Receivers are moved off their surfaces (compute_receiver_offset_m in frame_shared.h), so that
// rounding does not put them inside their own surface.

/// Share of a pixel's width at the receiver. The rasteriser snaps vertices to 1/256 of a pixel, and
/// surfaces move by as much.
constexpr double RECEIVER_OFFSET_PX = 1.0 / 16.0;
/// For float32, as a fraction of the lengths of which positions are made: the distance from the
/// camera, plus the larger one of the scene size S and the extent of all casters. 16 rounding
/// errors.
constexpr double RECEIVER_OFFSET_ROUNDING = 1e-6;
/// Maximum, as a fraction of S. The whole image has it if S is a few metres.
constexpr double MAX_RECEIVER_OFFSET = 5e-5;

/// Sine of the angle, half a degree, by which a face must be turned away from a light to be a
/// receiver on its far side (SceneSnapshot::has_far_sides).
constexpr float FAR_SIDE_SINE = 0.01f;
constexpr float NO_FAR_SIDE = 2.0f;

/// Fills the camera constants that the shaders read. p_size_px: size of the image.
shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);
/// The same, if the bounds of all casters are known.
shader::FrameConstants compute_frame_constants(
		const SceneSnapshot &p_scene, const Bounds &p_caster_bounds_world, glm::uvec2 p_size_px);

/// Camera-relative position of a pixel's centre in metres, from its reversed depth (above 0): the
/// CPU version of position_from_depth in depth_inc.glsl.
glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth);

} // namespace gnomon
