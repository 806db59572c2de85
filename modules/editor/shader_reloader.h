#pragma once

#include "modules/editor/editor_context.h"
#include "modules/shader_reload/shader_watcher.h"

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// Recompiles changed shader sources while the editor runs, and replaces the shaders. Errors are
/// shown in the viewport, and the last working version stays in use.
class ShaderReloader {
public:
	using Clock = std::chrono::steady_clock;

	/// p_folder: folder of the shader sources; if it does not exist, nothing is watched.
	ShaderReloader(RenderingDevice &p_device, const std::filesystem::path &p_folder) :
			device(p_device), watcher(p_folder) {}

	/// Call it once a frame; it checks the files twice a second. Returns true if shaders have been
	/// replaced.
	bool update(EditorContext &r_context, Clock::time_point p_now);

private:
	RenderingDevice &device;
	ShaderWatcher watcher;
	// Shaders that compile, in a set that the device refused: tried again with the next change.
	std::map<std::string, std::vector<uint32_t>> refused;
	Clock::time_point next_check;
};

} // namespace gnomon
