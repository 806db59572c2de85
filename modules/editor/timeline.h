#pragma once

#include "modules/scene/animation_playback.h"

#include <string>

namespace gnomon {

/// Selects the animation of the edited scene and its time, and poses the nodes accordingly. Poses
/// are neither saved nor undoable. Without an animation the scene is at rest: it shows the nodes'
/// own transforms, as when it is opened.
class Timeline {
public:
	/// p_default: name of the animation that play() chooses at rest before any was shown; if the
	/// scene has none of that name, its first.
	explicit Timeline(std::string p_default = {}) : default_name(std::move(p_default)) {}

	/// Must be called before any other method, and again after the scene was reloaded. If the scene
	/// has an animation with the name of the current one, it is selected and keeps its time and
	/// play state; otherwise the scene is at rest. r_scene must outlive this object.
	void set_scene(Scene &r_scene);
	/// Chooses an animation by name, from its start; an empty or unknown name puts the scene at
	/// rest, paused.
	void choose(const std::string &p_name);
	/// Sets the time, clamped to 0..duration. A value that is not finite is ignored.
	void seek(double p_time_s);
	void set_speed(double p_speed) { playback.speed = p_speed; }
	void set_loops(bool p_loops) { playback.loops = p_loops; }
	/// Starts playing, see AnimationPlayback::play. At rest it chooses the last shown animation, or
	/// the default. Does nothing if the scene has no animations. An animation of zero length is
	/// shown but does not play.
	void play();
	void pause() { playback.is_playing = false; }
	/// Advances by p_seconds of real time if it is playing. Returns true if the pose has changed.
	bool advance(double p_seconds);
	/// Poses the scene again after its nodes have changed.
	void pose();

	/// Returns the shown animation; null: the scene is at rest.
	const Animation *get_animation() const { return playback.animation.get(); }
	double get_time_s() const { return playback.time_s; }
	double get_speed() const { return playback.speed; }
	bool loops() const { return playback.loops; }
	bool is_playing() const { return playback.is_playing; }

private:
	Scene *scene = nullptr;
	std::string default_name;
	std::string last_name; // name of the last shown animation; empty: none yet
	AnimationPlayback playback{ .is_playing = false };
};

} // namespace gnomon
