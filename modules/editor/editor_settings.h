#pragma once

#include "modules/editor/editor_document.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// Sizes of the panels, which the user changes by dragging, as fractions of the window.
/// The height is a fraction of the window without toolbar and status bar.
struct EditorLayout {
	static constexpr float MIN_FRACTION = 0.08f;
	static constexpr float MAX_FRACTION = 0.45f;
	float left = 0.18f;	  // width of the scene tree
	float right = 0.31f;  // width of the inspector
	float bottom = 0.30f; // height of the tabs below the viewport
};

/// The user's settings, stored in editor.json in the config folder (get_config_folder).
struct EditorSettings {
	static constexpr size_t MAX_RECENT_COUNT = 10; // scenes in the list

	EditorLayout layout;
	glm::uvec2 window_size_px = glm::uvec2(1280, 720);
	std::string tab;			  // open tab below the viewport; empty: the first
	uint32_t sample_count = 1024; // rays per pixel of the error panel's reference
	bool shows_penumbra = true;	  // the viewport shows the edges of the selected light's penumbra
	/// Seconds after which changes are autosaved, 1 to 600.
	uint32_t autosave_s = uint32_t(EditorDocument::AUTOSAVE_INTERVAL.count());
	std::vector<std::string> recent; // absolute paths of scenes, newest first

	/// Loads the settings. Values that are missing or out of range get their defaults. A damaged
	/// file, or a value of a wrong type, gives all defaults and a warning in the log.
	static EditorSettings load();
	/// Saves the settings. A failure only logs a warning.
	void save() const;
	/// Returns the newest scene that still exists; empty: none.
	std::filesystem::path find_recent() const;
	/// Moves the scene to the front of the list, or adds it there.
	void add_recent(const std::filesystem::path &p_scene);
};

} // namespace gnomon
