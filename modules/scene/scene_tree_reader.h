#pragma once

#include "modules/scene/frame_snapshots.h"

// Parts of build_snapshot.

namespace gnomon {

/// As build_snapshot. r_posed: null = not wanted.
std::shared_ptr<const SceneSnapshot> read_scene_tree(
		const Scene &p_scene, const Camera3D &p_camera, PosedParts *r_posed);
/// Throws an Error that names the node if the transform is not finite.
void check_transform(const Node3D &p_node, const glm::dmat4 &p_world_from_node);
CameraSnapshot build_camera_snapshot(const Camera3D &p_camera);
/// Without the values of LightSnapshot::decide_settings.
LightSnapshot build_light_snapshot(const Light3D &p_light, const glm::dmat4 &p_world_from_node);

} // namespace gnomon
