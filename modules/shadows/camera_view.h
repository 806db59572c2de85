#pragma once

#include "modules/shadows/light_view.h"

#include "shared/frame_shared.h"

namespace gnomon {

/// The camera as a view, for culling: its sides and what is behind it. Its shift moves nothing.
LightView make_camera_view(const CameraSnapshot &p_camera, glm::uvec2 p_size_px);

/// What the camera's shift does in clip space, where w is the distance.
glm::dmat4 compute_shift(const CameraSnapshot &p_camera);

/// The camera as the shaders read it.
shader::FrameConstants compute_frame_constants(const SceneSnapshot &p_scene, glm::uvec2 p_size_px);

/// A pixel's point relative to the camera, from its reversed depth (above 0): position_from_depth
/// of depth_inc.glsl, for passes that run on the CPU.
glm::vec3 compute_position(const shader::FrameConstants &p_frame, glm::uvec2 p_size_px,
		glm::uvec2 p_pixel, float p_depth);

} // namespace gnomon
