#pragma once

#include "modules/main/game_window.h"

#include <functional>
#include <memory>
#include <string>

namespace gnomon {

/// What `gnomon run` can do only with modules that a build may lack; null where it cannot. The
/// files that need such a module fill it in before main begins.
struct OptionalParts {
	using SnapshotMaker = std::function<std::shared_ptr<const SceneSnapshot>()>;

	/// Of desktop: shows the scene until its window is closed. See game_window.h.
	RenderResult (*run_in_window)(Scene &r_scene, glm::uvec2 &r_size_px,
			const RunOptions &p_options, const CommonOptions &p_common) = nullptr;
	/// Of masks: the mask in an EXR.
	std::shared_ptr<const TruthMask> (*load_truth)(const std::string &p_path) = nullptr;
	/// Of masks: measure_frame_time, see measure.h.
	std::string (*measure_frame_time)(Renderer &r_renderer, RenderRequest p_request,
			const SnapshotMaker &p_make_snapshot) = nullptr;

	static OptionalParts &get() {
		static OptionalParts parts;
		return parts;
	}
};

} // namespace gnomon
