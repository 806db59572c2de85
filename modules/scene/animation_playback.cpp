#include "modules/scene/animation_playback.h"

#include <algorithm>

namespace gnomon {

void AnimationPlayback::play() {
	is_playing = true;
	if (!animation || loops) {
		return;
	}
	if (speed > 0 && time_s >= animation->duration_s) {
		time_s = 0;
	} else if (speed < 0 && time_s <= 0) {
		time_s = animation->duration_s;
	}
}

SceneChange AnimationPlayback::advance(Scene &r_scene, double p_seconds) {
	if (animation && is_playing) {
		const double next_s = time_s + p_seconds * speed;
		if (loops) {
			time_s = animation->wrap_time(next_s);
		} else {
			is_playing = speed < 0 ? next_s > 0 : speed == 0 || next_s < animation->duration_s;
			time_s = std::clamp(next_s, 0.0, animation->duration_s);
		}
	}
	return poser.pose(r_scene, animation, time_s);
}

void AnimationPlayback::apply(Scene &r_scene) const {
	pose_scene(r_scene, animation.get(), time_s);
}

} // namespace gnomon
