#pragma once

#include "modules/shadows/light_view.h"

#include "shared/frame_shared.h"

namespace gnomon {

/// Describes the camera as a view, for clip-space matrices and for culling (against the four sides
/// of its frustum and the plane z = 0). Ignores the subpixel shift (CameraSnapshot::shift).
LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px);

/// Clip-space matrix that applies the camera's subpixel shift (CameraSnapshot::shift). It expects w
/// to be the distance along the view, as a perspective projection makes it.
glm::dmat4 compute_shift(const CameraSnapshot &p_camera);

/// Fills the camera constants that the shaders read. p_size_px: size of the image.
shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);

/// Camera-relative position of a pixel's centre in metres, from its reversed depth (above 0): the
/// CPU version of position_from_depth in depth_inc.glsl.
glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth);

} // namespace gnomon
