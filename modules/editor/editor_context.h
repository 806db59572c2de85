#pragma once

#include "modules/core/error.h"
#include "modules/editor/background_reference.h"
#include "modules/editor/editor_document.h"
#include "modules/editor/orbit_camera.h"
#include "modules/editor/penumbra_guide.h"
#include "modules/masks/mask_image.h"
#include "modules/masks/mask_metrics.h"
#include "modules/masks/mask_timing.h"
#include "modules/renderer/renderer.h"

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// The ray from the camera through the point that was clicked in the viewport.
struct ViewportPick {
	glm::dvec3 origin_world = glm::dvec3(0.0);
	glm::dvec3 direction_world = glm::dvec3(0.0); // its component along the view axis is 1
};

/// The state of the viewport. The "active light" is that of EditorContext::find_light.
struct ViewportState {
	OrbitCamera camera;
	std::string debug_view;				// shown intermediate image; empty: the lit image
	glm::uvec2 size_px = glm::uvec2(0); // requested by the panel
	bool is_moving = false;				// an image of lower resolution is sufficient
	bool needs_redraw = true;			// something has changed since the last image
	/// Ids of the views of the active light, without the lit image: "mask", "error" once there is a
	/// reference, and those of its technique.
	std::vector<std::string> debug_views;
	bool wants_debug_views = false; // requests an update of debug_views
	/// Id of a technique that draws the active light right of the dividing line. Empty: no line.
	std::string compared_technique;
	float divider_position = 0.5f;	  // position of the dividing line, as a fraction of the width
	std::optional<ViewportPick> pick; // click that is not processed yet
	bool shows_penumbra = true;		  // draws penumbra_lines
	bool is_guide_changed = false;	  // shows_penumbra has changed
	std::vector<PenumbraLine> penumbra_lines; // of the selected light
};

/// The error of one light's mask against its reference, from the viewport's camera. ErrorMeter
/// writes the results.
struct ErrorState {
	/// Choices for sample_count. The published tables use 9216.
	static constexpr uint32_t SAMPLE_COUNTS[] = { 256, 1024, 4096, 9216 };
	bool is_shown = false;		  // the panel is visible
	bool is_stopped = false;	  // the user has stopped the tracing
	uint32_t sample_count = 1024; // target of the refinement, rays per pixel
	std::string refusal;		  // why there is no result; empty: there is one, or will be
	std::string light;			  // its name
	std::string technique;		  // technique of the light, chosen or by default
	MaskImage mask;
	ReferenceRound round;							// newest round of the reference
	std::shared_ptr<const ReferenceMask> reference; // null: none yet
	uint64_t reference_hash = 0; // compute_reference_hash of the reference or its trace; 0: none
	std::optional<MaskMetrics> metrics;
	MaskTiming cost;				 // of the mask
	bool is_tracing = false;		 // a round of the reference is running
	float progress = 0;				 // of the running round, 0..1
	uint32_t round_sample_count = 0; // rays per pixel of the running round
	void *mask_texture = nullptr;	 // ImTextureID; null: none yet
	void *reference_texture = nullptr;
	void *error_texture = nullptr;
};

/// A command that a button or a key requests. EditorSession::run_command executes it after the
/// panels are drawn, at most one per frame.
enum class EditorCommand {
	NONE,
	SHOW_OPEN_MENU,
	OPEN, // opens EditorContext::open_path
	SAVE,
	UNDO,
	REDO,
	FRAME,			// moves the camera so that the selected node or the scene is visible
	PLAY,			// saves, and runs the game on the scene
	PLAY_ANIMATION, // plays or pauses
	DUPLICATE,
	DELETE,
	OPEN_PAGE, // opens EditorContext::requested_page
	QUIT
};

/// State that is written to EditorOptions::items, for tests and benchmarks.
struct EditorProgress {
	uint64_t frame = 0;		  // frame counter
	uint32_t image_count = 0; // full-resolution images drawn so far
	bool is_resting = false;  // the window shows the current state; nothing is left to draw
	/// The latency in ms of each frame that changed the scene: from the start of the frame, before
	/// input is processed, until the frame is submitted.
	const std::vector<double> &answers_ms;
};

/// The state that all panels share. Panels change the scene only through the document.
struct EditorContext {
	EditorDocument &document;
	const DeviceInfo &device;
	ViewportState viewport;
	RenderResult shown;				// result of rendering the last image
	double shown_ms = 0;			// wall time of its rendering, with the compared image
	bool is_image_coarse = false;	// the last image has reduced resolution
	void *image = nullptr;			// ImTextureID; null: none yet
	void *compared_image = nullptr; // image with ViewportState::compared_technique; null: none
	glm::uvec2 image_size_px = glm::uvec2(0);
	ErrorState error;
	/// The text of the status bar: the last failure or action.
	std::string status;
	bool is_status_error = false;
	std::vector<std::string> messages; // errors and warnings, oldest first
	/// By shader name: the error because of which its last change is not in use.
	std::map<std::string, std::string> shader_errors;
	std::string inspector_filter;
	EditorCommand command = EditorCommand::NONE;
	/// For EditorCommand::OPEN_PAGE: a documentation page, relative to the folder above bin.
	std::string requested_page;
	bool shows_open_menu = false;	 // requests that the toolbar opens its menu of scenes
	std::filesystem::path open_path; // for EditorCommand::OPEN
	std::vector<std::string> recent; // recently opened scenes, newest first
	std::string shown_tab;			 // open tab of the bar below the viewport
	std::string requested_tab;		 // tab to open; cleared once it is open
	uint32_t dragged_handle = 0;	 // ImGuiID of a gizmo's handle; 0: none
	/// Rectangles of the widgets by name: left, top, right, bottom in window pixels. For tests.
	std::map<std::string, glm::vec4> items;

	void set_status(std::string p_text) {
		status = std::move(p_text);
		is_status_error = false;
	}
	/// Shows an error in the status bar and adds it to the messages.
	void report_error(std::string p_text) {
		const size_t MAX_MESSAGE_COUNT = 500;
		if (messages.size() >= MAX_MESSAGE_COUNT) {
			messages.erase(messages.begin());
		}
		messages.push_back(p_text);
		status = std::move(p_text);
		is_status_error = true;
	}
	/// Returns the active light, which the debug views, the comparison and the error panel show:
	/// the selected one, else the first that casts a shadow. Null: none.
	const Light3D *find_light() const;
	std::string find_light_name() const; // empty: none
	/// Builds a snapshot of the scene as the viewport's camera sees it.
	std::shared_ptr<const SceneSnapshot> build_viewport_snapshot() const;
	/// Records the rectangle of the last drawn widget, except in a window that has just opened.
	void record_item_rect(const std::string &p_name);
	/// Begins a tab of the bar below the viewport. If it returns true, the tab is open and the
	/// caller must call ImGui::EndTabItem. p_addition: text after the name.
	bool begin_tab(const char *p_name, const std::string &p_addition = {});
	/// Draws a tab, with p_draw for its contents.
	void draw_tab(const char *p_name, const std::function<void()> &p_draw,
			const std::string &p_addition = {});
	/// Formats the rectangles, the progress and the editor's state as JSON, for
	/// EditorOptions::items.
	std::string describe_items(const EditorProgress &p_progress) const;
	/// Runs a user's action. An exception is shown in the status bar.
	template <typename Action> void attempt(const Action &p_action) {
		viewport.needs_redraw = true; // also after a failure, which may have changed the scene
		try {
			p_action();
		} catch (const std::exception &failure) {
			report_error(describe_failure(failure));
		}
	}
};

/// ImGuiWindowFlags of every panel. They prevent moving and resizing, which the layout does.
extern const int PANEL_FLAGS;

struct EditorLayout;
/// Draws all panels over the whole window.
void draw_layout(EditorContext &r_context, EditorLayout &r_layout);

// The panels. Each function draws one panel with Dear ImGui.
void draw_toolbar(EditorContext &r_context);
void draw_scene_tree(EditorContext &r_context);
void draw_inspector(EditorContext &r_context);
void draw_viewport(EditorContext &r_context);
void draw_timeline(EditorContext &r_context);
void draw_error(EditorContext &r_context);	  // within a tab bar
void draw_plan(EditorContext &r_context);	  // within a tab bar
void draw_modules(EditorContext &r_context);  // within a tab bar
void draw_messages(EditorContext &r_context); // within a tab bar
void draw_status(EditorContext &r_context);

} // namespace gnomon
