#pragma once

#include <godot_api.gen.h>

#include <optional>

namespace gnomon {

/// TIME of Godot's shaders, which Godot does not hand out: the sum of the scaled steps of the
/// frames that were drawn, with its rollover. Main thread only.
///
/// A step is the process time of its frame, except for frames so slow that Godot skips physics
/// steps: it is then longer by an integral number of those, which is estimated, and corrected in
/// the next frame by what a small view has drawn of TIME.
class ShaderTime {
public:
	ShaderTime();
	~ShaderTime();
	ShaderTime(const ShaderTime &) = delete;
	ShaderTime &operator=(const ShaderTime &) = delete;

	/// Call it before each draw.
	void update();
	/// Returns TIME of the frame that is about to be drawn, in seconds. The first frames after a
	/// pause in its use may be wrong.
	double use();

private:
	/// A view of two pixels, in which a shader writes the bits of TIME.
	class View;
	void add_step(const godot::Engine &p_engine);
	/// Corrects time_s, which is that of the frame before.
	void correct(const godot::Engine &p_engine);

	double time_s = 0;
	int64_t drawn_frames = -1; // Godot's counts, and its clock, at the last step
	int64_t physics_frames = 0;
	int64_t begin_usec = 0;
	bool is_estimated = true;
	uint32_t unused_frames = 0;
	std::unique_ptr<View> view; // while it is used
	godot::Callable on_physics_frame;
	bool is_connected = false;
	std::shared_ptr<int64_t> step_usec = std::make_shared<int64_t>(0);
};

} // namespace gnomon
