#pragma once

#include "modules/editor/editor_document.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// Where the panels are: shares of the window, which the lines between them change.
struct EditorLayout {
	static constexpr float LEAST_SHARE = 0.08f;
	static constexpr float GREATEST_SHARE = 0.45f;
	float left = 0.18f;	  // the scene tree's width
	float right = 0.31f;  // the inspector's
	float bottom = 0.30f; // height of error, plan and modules
};

/// What the editor remembers of a user from one time to the next: editor.json in the folder for a
/// user's choices.
struct EditorSettings {
	static constexpr size_t MOST_RECENT = 10;

	EditorLayout layout;
	glm::uvec2 window_size_px = glm::uvec2(1280, 720);
	std::string tab;			  // that is open below the viewport; empty: the first
	uint32_t sample_count = 1024; // rays a pixel of the error panel's reference
	bool shows_penumbra = true;	  // in the viewport
	/// After which changes are saved aside, 1 to 600.
	uint32_t autosave_s = uint32_t(EditorDocument::AUTOSAVE_INTERVAL.count());
	std::vector<std::string> recent; // scenes, absolute, the newest first

	/// What is missing or out of range has its default; a damaged file only warns.
	static EditorSettings load();
	/// A failure only warns.
	void save() const;
	/// The newest that is still there; empty: none is.
	std::filesystem::path find_recent() const;
	/// Puts the scene in front.
	void add_recent(const std::filesystem::path &p_scene);
};

} // namespace gnomon
