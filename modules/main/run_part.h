#pragma once

#include "modules/core/extension_registry.h"
#include "modules/main/game_window.h"

#include <functional>
#include <memory>
#include <string>

namespace gnomon {

/// Features of `gnomon run` that an optional module provides; a member is null if the module does
/// not provide it.
struct RunPart {
	using SnapshotMaker = std::function<std::shared_ptr<const SceneSnapshot>()>;

	std::string id; // id of the module
	/// Shows the scene until its window is closed. See game_window.h.
	RenderResult (*run_in_window)(Scene &r_scene, glm::uvec2 &r_size_px,
			const RunOptions &p_options, const CommonOptions &p_common) = nullptr;
	/// Loads the reference mask from an EXR.
	std::shared_ptr<const ReferenceMask> (*load_reference)(const std::string &p_path) = nullptr;
	/// See measure.h.
	std::string (*measure_time)(Renderer &r_renderer, RenderRequest p_request,
			uint32_t p_warm_up_count, uint32_t p_count,
			const SnapshotMaker &p_make_snapshot) = nullptr;
};
class RunPartRegistry : public ExtensionRegistry<RunPart> {};

// Ids of the parts.
inline constexpr const char *DESKTOP_PART = "desktop";
inline constexpr const char *MASKS_PART = "masks";

} // namespace gnomon
