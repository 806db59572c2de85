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
	bool loops = true; // false: it pauses at its end; played backwards, at its begin

	/// Plays; from the other end where it has paused at one.
	void play();
	/// Goes on by so many seconds of real time and poses the scene.
	void advance(Scene &r_scene, double p_seconds);
	/// Poses the scene as it is now.
	void apply(Scene &r_scene) const;
};

} // namespace gnomon
