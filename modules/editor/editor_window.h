#pragma once

#include "modules/scene/stage.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace gnomon {

struct EditorOptions {
	std::filesystem::path path; // a project or a scene; empty: the last opened scene
	std::string device;
	bool validation = false;
	StageMode stage = StageMode::AUTO;
	std::filesystem::path program; // this program's executable: bin/gnomon next to doc and shaders
	/// Folder of the shader sources, which are recompiled when they change; need not exist.
	std::filesystem::path shaders;
	/// File to which widget rectangles are written as JSON each frame; empty: none. For tests.
	std::filesystem::path items;
	uint32_t frame_count = 0; // number of frames to run; 0: until the window is closed
};

/// Runs the editor until its window is closed. A missing display or scene is an Error.
void run_editor(const EditorOptions &p_options);

} // namespace gnomon
