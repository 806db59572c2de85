#pragma once

#include "modules/scene/scene_snapshot.h"

#include <vector>

namespace gnomon {

/// What may have changed in a scene, other than its camera, since its last snapshot. A greater
/// value includes the lesser ones.
enum class SceneChange {
	NONE,
	/// Only the posed transforms and weights of nodes that were posed then.
	POSE,
	ANY,
};

/// The parts of a snapshot that a pose can move, see SceneChange::POSE.
struct PosedParts {
	struct Instances {
		const MeshInstance3D *node = nullptr;
		glm::dmat4 world_from_node = glm::dmat4(1.0);
		uint32_t first = 0; // of SceneSnapshot::instances
		uint32_t count = 0;
	};
	struct Light {
		const Light3D *node = nullptr;
		glm::dmat4 world_from_node = glm::dmat4(1.0);
		uint32_t index = 0; // of SceneSnapshot::lights
	};
	std::vector<Instances> instances;
	std::vector<Light> lights;
	bool has_deformable = false; // meshes with a rig, which any node may move
};

/// The snapshots of consecutive frames of one scene. A frame's snapshot shares the lights and
/// instances that have not moved with that of the frame before, and nothing loops over them.
class FrameSnapshots {
public:
	/// Returns what build_snapshot returns. p_change: since the last call; ignored in the first.
	/// Unless it is ANY, the scene must still have all nodes of the last call.
	std::shared_ptr<const SceneSnapshot> build(
			const Scene &p_scene, const Camera3D &p_camera, SceneChange p_change);

private:
	/// Moves what the pose moves.
	void apply_pose();

	std::shared_ptr<const SceneSnapshot> last;
	PosedParts posed;
};

} // namespace gnomon
