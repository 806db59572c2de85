#pragma once

#include "modules/scene/stage.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace gnomon {

struct EditorOptions {
	std::filesystem::path path; // a project, or a scene; empty: what was open last
	std::string device;
	bool validation = false;
	StageMode stage = StageMode::AUTO;
	std::filesystem::path program; // this program's file: bin/gnomon next to doc and shaders
	/// Where the shaders' sources are, to be recompiled when they change; may not be there.
	std::filesystem::path shaders;
	/// Where widgets are, written as JSON each frame; empty: nowhere. For tests.
	std::filesystem::path items;
	uint32_t frame_count = 0; // ends after so many; 0: when the window is closed
};

/// Shows the editor until its window is closed. No display, or no such scene: an Error.
void run_editor(const EditorOptions &p_options);

} // namespace gnomon
