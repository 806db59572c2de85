#pragma once

#include "modules/scene/scene_snapshot.h"

namespace gnomon {

/// The snapshots of consecutive frames of one scene. If nothing but the camera has moved, a frame's
/// snapshot shares instances and lights with that of the frame before, and nothing loops over them.
class FrameSnapshots {
public:
	/// Returns what build_snapshot returns. p_has_changed: the scene may have changed since the
	/// last call, other than its camera. Ignored in the first call.
	std::shared_ptr<const SceneSnapshot> build(
			const Scene &p_scene, const Camera3D &p_camera, bool p_has_changed);

private:
	std::shared_ptr<const SceneSnapshot> last;
};

} // namespace gnomon
