#pragma once

#include "modules/editor/editor_document.h"
#include "modules/editor/orbit_camera.h"
#include "modules/renderer/renderer.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace gnomon {

/// What the viewport shows, and how.
struct ViewportState {
	OrbitCamera camera;
	std::string debug_view;				// empty: the picture
	glm::uvec2 size_px = glm::uvec2(0); // wanted by the panel
	bool is_moving = false;				// a coarser picture will do
	bool needs_picture = true;			// something has changed since the last one
};

/// What a button or a key asks for; done once a frame, after the panels.
enum class EditorCommand { NONE, SAVE, UNDO, REDO, FRAME, PLAY, DUPLICATE, DELETE, QUIT };

/// What all panels share. They change the scene through the document alone.
struct EditorContext {
	EditorDocument &document;
	const DeviceInfo &device;
	ViewportState viewport;
	/// Of the last picture.
	RenderResult shown;
	double shown_ms = 0;	 // wall time
	void *picture = nullptr; // ImTextureID; null: none yet
	glm::uvec2 picture_size_px = glm::uvec2(0);
	/// What went wrong or was done last, for the status bar.
	std::string status;
	bool is_status_error = false;
	std::vector<std::string> messages; // errors and warnings, the newest last
	std::string inspector_filter;
	EditorCommand command = EditorCommand::NONE;
	uint32_t dragged_handle = 0; // ImGuiID of a gizmo's handle; 0: none
	/// Where widgets are in the window, by name: left, top, right, bottom in pixels. For tests.
	std::map<std::string, glm::vec4> items;

	void say(std::string p_text) {
		status = std::move(p_text);
		is_status_error = false;
	}
	void complain(std::string p_text) {
		const size_t MOST_MESSAGES = 500;
		if (messages.size() >= MOST_MESSAGES) {
			messages.erase(messages.begin());
		}
		messages.push_back(p_text);
		status = std::move(p_text);
		is_status_error = true;
	}
	/// Notes where the widget is that was drawn last.
	void note_item(const std::string &p_name);
	/// These places, and what a test waits for, as JSON. p_picture_count: sharp ones that were
	/// drawn.
	std::string describe_items(uint32_t p_picture_count) const;
	/// Runs what a user asked for; an Error becomes the status.
	template <typename Action> void attempt(const Action &p_action) {
		try {
			p_action();
			viewport.needs_picture = true;
		} catch (const std::exception &error) {
			complain(error.what());
		}
	}
};

/// ImGuiWindowFlags of every panel: the layout gives it its place.
extern const int PANEL_FLAGS;

// The panels; each draws its window with Dear ImGui.
void draw_toolbar(EditorContext &r_context);
void draw_scene_tree(EditorContext &r_context);
void draw_inspector(EditorContext &r_context);
void draw_viewport(EditorContext &r_context);
void draw_plan(EditorContext &r_context);	  // within a tab bar
void draw_modules(EditorContext &r_context);  // likewise
void draw_messages(EditorContext &r_context); // likewise
void draw_status(EditorContext &r_context);

} // namespace gnomon
