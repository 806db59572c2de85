#pragma once

#include "modules/scene/frame_snapshots.h"
#include "modules/scene/node_transform.h"
#include "modules/scene/nodes.h"
#include "modules/scene/scene_snapshot.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

enum class Interpolation { STEP, LINEAR, CUBIC_SPLINE };

/// Which property of a node an animation channel drives.
enum class AnimatedPath { TRANSLATION, ROTATION, SCALE, WEIGHTS };

/// Keyframes and their interpolation (glTF 2.0, 3.11 and appendix C).
struct AnimationSampler {
	Interpolation interpolation = Interpolation::LINEAR;
	std::vector<float> times_s; // ascending; at least one
	uint32_t component_count = 0;
	/// component_count values per key time; for CUBIC_SPLINE three such elements per key:
	/// in-tangent, value, out-tangent.
	std::vector<float> values;

	/// Samples in double precision, clamped to the first and last key. p_is_rotation: the values
	/// are unit quaternions x y z w, interpolated along the shorter arc.
	std::vector<double> sample(double p_time_s, bool p_is_rotation) const;
};

struct AnimationChannel {
	int node = -1; // Node3D::file_index
	AnimatedPath path = AnimatedPath::TRANSLATION;
	AnimationSampler sampler;
};

/// A node's transform as loaded from the file; channels replace its translation, rotation or scale.
struct AnimatedNode {
	int node = -1; // Node3D::file_index
	NodeTransform transform;
};

/// An animation clip. It is immutable once shared.
struct Animation {
	std::string name; // unique in its scene
	std::vector<AnimationChannel> channels;
	std::vector<AnimatedNode> nodes; // the nodes that channels animate
	double duration_s = 0;			 // the last key time of all channels

	/// Wraps a time into 0..duration_s by looping; returns 0 if the duration is 0 or the time is
	/// not finite.
	double wrap_time(double p_time_s) const;
};

/// Sets the posed transforms and weights of the scene's nodes to those of the animation at a time,
/// clamped to its first and last key; all other nodes return to rest. Null resets all nodes.
/// The nodes' own transforms and weights do not change: see Node3D::posed_parent_from_node.
void pose_scene(Scene &r_scene, const Animation *p_animation, double p_time_s);

/// A node that an animation poses, and how.
struct AnimatedNodePose {
	Node3D *node = nullptr;
	NodeTransform file_transform; // see AnimatedNode
	std::vector<const AnimationChannel *> channels;
};

/// Poses one scene at one time after another. If it was the last to pose the scene, it poses only
/// the animated nodes.
class ScenePoser {
public:
	/// Poses the scene as pose_scene does. Returns what has changed since the last call. An
	/// animation of other nodes, another scene or a changed tree is ANY.
	SceneChange pose(Scene &r_scene, std::shared_ptr<const Animation> p_animation, double p_time_s);

private:
	const Node3D *root = nullptr;
	std::shared_ptr<const Animation> animation;
	uint64_t tree_revision = 0;
	double time_s = 0;
	std::vector<AnimatedNodePose> poses;
};

/// Builds a snapshot, as build_snapshot does, of the scene posed by the animation at a time; null:
/// at rest. Afterwards the scene has its previous pose again.
std::shared_ptr<const SceneSnapshot> build_posed_snapshot(const Scene &p_scene,
		const Camera3D &p_camera, const Animation *p_animation, double p_time_s);

/// Finds an animation by name; an empty name gives the first, or null if there is none. An unknown
/// name is an Error that lists the existing ones.
std::shared_ptr<const Animation> find_animation(const Scene &p_scene, const std::string &p_name);

} // namespace gnomon
