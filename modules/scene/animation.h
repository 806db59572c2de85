#pragma once

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

/// What an animation moves of a node.
enum class AnimatedPath { TRANSLATION, ROTATION, SCALE, WEIGHTS };

/// Values at times, and what is between them (glTF 2.0, 3.11 and appendix C).
struct AnimationSampler {
	Interpolation interpolation = Interpolation::LINEAR;
	std::vector<float> times_s; // growing; at least one
	uint32_t component_count = 0;
	/// component_count for each time; of CUBIC_SPLINE three times as many: in-tangents, values,
	/// out-tangents.
	std::vector<float> values;

	/// In double. Before the first time and after the last, its value. p_is_rotation: quaternions
	/// x y z w, which stay unit and turn the shorter way.
	std::vector<double> sample(double p_time_s, bool p_is_rotation) const;
};

struct AnimationChannel {
	int node = -1; // Node3D::file_index
	AnimatedPath path = AnimatedPath::TRANSLATION;
	AnimationSampler sampler;
};

/// A node's transform as its file has it: channels replace parts of it.
struct AnimatedNode {
	int node = -1; // Node3D::file_index
	NodeTransform transform;
};

/// Never changes once it is shared.
struct Animation {
	std::string name; // unique in its scene
	std::vector<AnimationChannel> channels;
	std::vector<AnimatedNode> nodes; // those that channels move
	double duration_s = 0;			 // the last time of all channels

	/// In 0..duration_s, as often as it has to be repeated for that; 0 where it has no duration.
	double wrap_time(double p_time_s) const;
};

/// Puts the scene's nodes where the animation has them at a time, clamped to its first and last
/// values; all others back where they belong. Null: all of them. The nodes' own transforms and
/// weights stay as they are: see Node3D::posed_parent_from_node.
void pose_scene(Scene &r_scene, const Animation *p_animation, double p_time_s);

/// As build_snapshot, of the scene as the animation has it at a time; null: at rest. The scene is
/// left as it was posed before.
std::shared_ptr<const SceneSnapshot> build_posed_snapshot(const Scene &p_scene,
		const Camera3D &p_camera, const Animation *p_animation, double p_time_s);

/// By its name; empty: the first, or null where there is none. Another name: an Error that lists
/// those that there are.
std::shared_ptr<const Animation> find_animation(const Scene &p_scene, const std::string &p_name);

} // namespace gnomon
