#pragma once

#include "modules/editor/editor_context.h"
#include "modules/shader_reload/shader_watcher.h"

#include <chrono>

namespace gnomon {

/// Takes over changed shader sources while the editor runs. What does not compile is reported in
/// the viewport, and the last good one stays.
class ShaderReloader {
public:
	using Clock = std::chrono::steady_clock;

	/// p_folder: of the shaders' sources; where it is not there, nothing is watched.
	ShaderReloader(RenderingDevice &p_device, const std::filesystem::path &p_folder) :
			device(p_device), watcher(p_folder) {}

	/// Looks twice a second. True: some shaders are others now.
	bool update(EditorContext &r_context, Clock::time_point p_now);

private:
	RenderingDevice &device;
	ShaderWatcher watcher;
	Clock::time_point next_look;
};

} // namespace gnomon
