#pragma once

#include "modules/core/extension_registry.h"
#include "modules/main/game_window.h"

#include <functional>
#include <memory>
#include <string>

namespace gnomon {

/// What `gnomon run` can do only with a module that a build may lack; null where that module gives
/// nothing of the kind.
struct RunPart {
	using SnapshotMaker = std::function<std::shared_ptr<const SceneSnapshot>()>;

	std::string id; // the module
	/// Shows the scene until its window is closed. See game_window.h.
	RenderResult (*run_in_window)(Scene &r_scene, glm::uvec2 &r_size_px,
			const RunOptions &p_options, const CommonOptions &p_common) = nullptr;
	/// The mask in an EXR.
	std::shared_ptr<const ReferenceMask> (*load_reference)(const std::string &p_path) = nullptr;
	/// See measure.h.
	std::string (*measure_time)(Renderer &r_renderer, RenderRequest p_request,
			uint32_t p_warm_up_count, uint32_t p_count,
			const SnapshotMaker &p_make_snapshot) = nullptr;
};
class RunPartRegistry : public ExtensionRegistry<RunPart> {};

// The ids.
inline constexpr const char *DESKTOP_PART = "desktop";
inline constexpr const char *MASKS_PART = "masks";

} // namespace gnomon
