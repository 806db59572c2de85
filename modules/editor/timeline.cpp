#include "modules/editor/timeline.h"

#include <algorithm>
#include <cmath>

namespace gnomon {

namespace {

/// Finds an animation by name. Returns null if there is none.
std::shared_ptr<const Animation> find(const Scene &p_scene, const std::string &p_name) {
	for (const std::shared_ptr<const Animation> &animation : p_scene.animations) {
		if (animation->name == p_name) {
			return animation;
		}
	}
	return nullptr;
}

} // namespace

void Timeline::set_scene(Scene &r_scene) {
	scene = &r_scene;
	const std::string shown = playback.animation ? playback.animation->name : std::string();
	const double time_s = playback.time_s;
	const bool was_playing = playback.is_playing;
	choose(shown);
	if (playback.animation) {
		playback.is_playing = was_playing;
		seek(time_s);
	}
}

void Timeline::choose(const std::string &p_name) {
	playback.animation = p_name.empty() ? nullptr : find(*scene, p_name);
	playback.time_s = 0;
	if (playback.animation) {
		last_name = p_name;
	} else {
		playback.is_playing = false;
	}
	playback.apply(*scene);
}

void Timeline::seek(double p_time_s) {
	if (playback.animation && std::isfinite(p_time_s)) {
		playback.time_s = std::clamp(p_time_s, 0.0, playback.animation->duration_s);
		playback.apply(*scene);
	}
}

void Timeline::play() {
	if (scene->animations.empty()) {
		return;
	}
	if (!playback.animation) {
		const std::string first = scene->animations.front()->name;
		choose(find(*scene, last_name)				 ? last_name
						: find(*scene, default_name) ? default_name
													 : first);
	}
	if (playback.animation->duration_s > 0) { // otherwise it is a single pose
		playback.play();
	}
}

bool Timeline::advance(double p_seconds) {
	if (!playback.animation || !playback.is_playing) {
		return false;
	}
	const double before_s = playback.time_s;
	playback.advance(*scene, p_seconds);
	return playback.time_s != before_s;
}

void Timeline::pose() {
	if (!scene->animations.empty()) {
		playback.apply(*scene);
	}
}

} // namespace gnomon
