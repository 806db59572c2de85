#pragma once

#include "modules/scene/animation.h"

#include <memory>

namespace gnomon {

/// Plays one animation of a scene.
class AnimationPlayback {
public:
	std::shared_ptr<const Animation> animation; // null: the scene is at rest
	double time_s = 0;							// in 0..duration
	double speed = 1;							// below 0: backwards
	bool is_playing = true;
	bool loops = true; // false: it pauses at its end, or at its start when played backwards

	/// Starts playing; if it does not loop and is at its end, it restarts from the other end.
	void play();
	ScenePoser poser; // used by advance()
	/// Advances by p_seconds of real time, times the speed, and poses the scene. Returns what has
	/// changed since the call before, if nothing else has posed the scene.
	SceneChange advance(Scene &r_scene, double p_seconds);
	/// Poses the scene at the current time, whatever posed it before.
	void apply(Scene &r_scene) const;
};

} // namespace gnomon
