#pragma once

#include "modules/shadows/light_view.h"

#include "shared/frame_shared.h"

namespace gnomon {

/// The camera as a view, for culling against its four sides and its back. Ignores the subpixel
/// shift (CameraSnapshot::shift).
LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px);

/// The camera's subpixel shift as a clip-space matrix; w is the distance along the view.
glm::dmat4 compute_shift(const CameraSnapshot &p_camera);

/// The camera as the shaders read it.
shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);

/// Camera-relative position of a pixel's centre in metres, from its reversed depth (above 0): the
/// CPU version of position_from_depth in depth_inc.glsl.
glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth);

} // namespace gnomon
