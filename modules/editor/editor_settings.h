#pragma once

#include "modules/editor/editor_document.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// Sizes of the panels as fractions of the window, which the user drags.
struct EditorLayout {
	static constexpr float LEAST_SHARE = 0.08f;
	static constexpr float GREATEST_SHARE = 0.45f;
	float left = 0.18f;	  // width of the scene tree
	float right = 0.31f;  // width of the inspector
	float bottom = 0.30f; // height of the error, plan and module tabs
};

/// Settings that persist between sessions of a user: editor.json in the config folder.
struct EditorSettings {
	static constexpr size_t MOST_RECENT = 10;

	EditorLayout layout;
	glm::uvec2 window_size_px = glm::uvec2(1280, 720);
	std::string tab;			  // open tab below the viewport; empty: the first
	uint32_t sample_count = 1024; // rays per pixel of the error panel's reference
	bool shows_penumbra = true;	  // in the viewport
	/// Seconds after which changes are autosaved, 1 to 600.
	uint32_t autosave_s = uint32_t(EditorDocument::AUTOSAVE_INTERVAL.count());
	std::vector<std::string> recent; // absolute paths of scenes, newest first

	/// Loads the settings. Values that are missing or out of range get their defaults; a damaged
	/// file only warns.
	static EditorSettings load();
	/// Saves the settings; a failure only warns.
	void save() const;
	/// Returns the newest scene that still exists; empty: none.
	std::filesystem::path find_recent() const;
	/// Moves the scene to the front of the list.
	void add_recent(const std::filesystem::path &p_scene);
};

} // namespace gnomon
