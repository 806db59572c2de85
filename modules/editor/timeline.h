#pragma once

#include "modules/scene/animation_playback.h"

#include <string>

namespace gnomon {

/// Which animation of the edited scene is shown, and at which time. It poses nodes alone, and that
/// is never saved and no step to undo. A scene is at rest at first: as its file has it.
class Timeline {
public:
	/// p_default: the name of the animation that play() chooses at rest; where the scene has none
	/// of that name, its first.
	explicit Timeline(std::string p_default = {}) : default_name(std::move(p_default)) {}

	/// The scene, which may be another one, has just been read. The same animation is shown at the
	/// same time, if it has one of that name; else it is at rest. r_scene must outlive it.
	void set_scene(Scene &r_scene);
	/// By its name, from its begin; empty, or a name that the scene lacks: at rest, paused.
	void choose(const std::string &p_name);
	/// Clamped to 0..duration. What is not finite changes nothing.
	void seek(double p_time_s);
	void set_speed(double p_speed) { playback.speed = p_speed; }
	void set_loops(bool p_loops) { playback.loops = p_loops; }
	/// At rest: the animation that was shown last, else the default. Without animations: nothing.
	void play();
	void pause() { playback.is_playing = false; }
	/// While it plays: goes on by so many seconds of real time. True: the scene is posed otherwise.
	bool advance(double p_seconds);
	/// Poses the scene again, whose nodes have changed.
	void pose();

	/// Null: at rest.
	const Animation *get_animation() const { return playback.animation.get(); }
	double get_time_s() const { return playback.time_s; }
	double get_speed() const { return playback.speed; }
	bool loops() const { return playback.loops; }
	bool is_playing() const { return playback.is_playing; }

private:
	Scene *scene = nullptr;
	std::string default_name;
	std::string last_name; // of the animation that was shown last; empty: none yet
	AnimationPlayback playback{ .is_playing = false };
};

} // namespace gnomon
