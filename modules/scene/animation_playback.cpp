#include "modules/scene/animation_playback.h"

namespace gnomon {

void AnimationPlayback::advance(Scene &r_scene, double p_seconds) {
	if (animation && is_playing) {
		time_s = animation->wrap_time(time_s + p_seconds * speed);
	}
	apply(r_scene);
}

void AnimationPlayback::apply(Scene &r_scene) const {
	pose_scene(r_scene, animation.get(), time_s);
}

} // namespace gnomon
