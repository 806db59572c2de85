#pragma once

#include "modules/main/commands.h"
#include "modules/renderer/renderer.h"
#include "modules/scene/animation_playback.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

struct RunOptions {
	std::string scene;
	bool is_headless = false;
	uint32_t frame_count = 0; // 0 = one frame headless, or until the window is closed
	std::string capture;
	std::optional<std::string> size;	  // nothing = the project's
	std::optional<uint32_t> antialiasing; // nothing = the project's; 1..4
	std::string camera;
	std::string technique;
	std::string debug_view;
	std::shared_ptr<const ReferenceMask> reference; // null: none
	std::vector<std::string> settings;
	AnimationPlayback playback;
	bool prints_plan = false;
	std::string dot;
	std::string time; // headless: path for the JSON of frame times
	bool is_still = false;
	bool skips_nothing = false;
};

/// Shows the scene in a window until it is closed or frame_count is reached. Returns the last
/// frame, with its image when options request a capture (r_size_px: its size).
RenderResult run_in_window(Scene &r_scene, glm::uvec2 &r_size_px, const RunOptions &p_options,
		const CommonOptions &p_common);

} // namespace gnomon
