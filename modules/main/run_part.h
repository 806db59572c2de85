#pragma once

#include "modules/core/extension_registry.h"
#include "modules/main/game_window.h"

#include <functional>
#include <memory>
#include <string>

namespace gnomon {

/// Features of `gnomon run` that exist only if the build contains an optional module. A null member
/// is not among that module's features.
struct RunPart {
	/// Builds a snapshot of the scene's current state.
	using SnapshotBuilder = std::function<std::shared_ptr<const SceneSnapshot>()>;

	std::string id; // name of the optional module
	/// Shows the scene in a window, see run_in_window in game_window.h.
	RenderResult (*run_in_window)(Scene &r_scene, glm::uvec2 &r_size_px,
			const RunOptions &p_options, const CommonOptions &p_common) = nullptr;
	/// Loads a reference mask from an EXR file. Throws an Error if that fails.
	std::shared_ptr<const ReferenceMask> (*load_reference)(
			const std::filesystem::path &p_path) = nullptr;
	/// Measures frame times, see measure_time in measure.h.
	std::string (*measure_time)(Renderer &r_renderer, RenderRequest p_request,
			uint32_t p_warm_up_count, uint32_t p_count,
			const SnapshotBuilder &p_build_snapshot) = nullptr;
};
/// The RunParts of this build. initialize_desktop_part() and initialize_masks_part() add them.
class RunPartRegistry : public ExtensionRegistry<RunPart> {};

// Values of RunPart::id.
inline constexpr const char *DESKTOP_PART = "desktop";
inline constexpr const char *MASKS_PART = "masks";

} // namespace gnomon
