#pragma once

#include "modules/main/commands.h"
#include "modules/renderer/renderer.h"
#include "modules/scene/animation_playback.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// The options of `gnomon run`.
struct RunOptions {
	std::filesystem::path scene;
	bool is_headless = false;
	uint32_t frame_count = 0;		 // 0: one frame if headless, else until the window is closed
	std::filesystem::path capture;	 // the PNG of the last frame; empty: none
	std::optional<std::string> size; // "WIDTHxHEIGHT"; unset: see choose_size
	std::optional<uint32_t> antialiasing; // 1..4; unset: see choose_antialiasing
	std::string camera;					  // name; empty: the first camera
	std::string technique;				  // id that replaces every light's; empty: no override
	std::string debug_view;				  // see RenderRequest::debug_view; empty: the lit image
	std::shared_ptr<const ReferenceMask> reference; // null: none
	std::vector<std::string> settings;				// arguments of --set, see apply_setting
	AnimationPlayback playback;
	bool prints_plan = false;		 // prints the frame plan: passes that ran and that were skipped
	std::filesystem::path dot;		 // the frame graph in Graphviz format; empty: none
	std::filesystem::path time_path; // --time, headless: the JSON file to write; empty: none
	bool is_still = false;			 // --still: the frames of --time may reuse cached results
	bool is_playing = false;		 // --playing: as is_still, while the animation plays
	bool skips_nothing = false;		 // headless: also runs passes that the image does not need
};

/// Shows the scene in a window until the window is closed or p_options.frame_count frames are
/// drawn. r_size_px: initial size of the window in pixels; receives the size of the last frame.
/// Returns the result of the last frame, with its image if a capture is requested.
RenderResult run_in_window(Scene &r_scene, glm::uvec2 &r_size_px, const RunOptions &p_options,
		const CommonOptions &p_common);

} // namespace gnomon
