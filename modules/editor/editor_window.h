#pragma once

#include "modules/scene/stage.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace gnomon {

/// Options of the command `gnomon edit`.
struct EditorOptions {
	std::filesystem::path path; // a project or a scene; empty: the last opened scene
	std::string device;			// index or part of the name; empty: the engine's choice
	bool validation = false;	// Vulkan's validation layers
	StageMode stage = StageMode::AUTO;
	std::filesystem::path program; // this program's executable; its folder, bin, is next to doc
	/// Folder of the shader sources, which are recompiled when they change. It need not exist.
	std::filesystem::path shaders;
	/// File to which the widgets' rectangles and the progress are written as JSON each frame, for
	/// tests; empty: none.
	std::filesystem::path items;
	uint32_t frame_count = 0; // number of frames to run; 0: until the window is closed
};

/// Runs the editor until its window is closed, or for EditorOptions::frame_count frames. A missing
/// display or scene is an Error.
void run_editor(const EditorOptions &p_options);

} // namespace gnomon
