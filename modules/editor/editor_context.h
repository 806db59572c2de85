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

/// A click in the viewport.
struct ViewportPick {
	glm::dvec3 origin_world = glm::dvec3(0.0);
	glm::dvec3 direction_world = glm::dvec3(0.0);
};

/// What the viewport shows, and how.
struct ViewportState {
	OrbitCamera camera;
	std::string debug_view;				// empty: the lit image
	glm::uvec2 size_px = glm::uvec2(0); // requested by the panel
	bool is_moving = false;				// a coarser image will do
	bool needs_redraw = true;			// something has changed since the last image
	/// The views of the light in question, other than the lit image: "mask", "error", and the
	/// technique's own.
	std::vector<std::string> debug_views;
	bool wants_debug_views = false; // requests that list again
	/// Id of a technique that draws the light in question right of the dividing line. Empty: no
	/// line.
	std::string compared_technique;
	float compared_from = 0.5f; // position of the dividing line, as a fraction of the width
	std::optional<ViewportPick> pick;
	bool shows_penumbra = true; // for the selected light
	bool is_guide_changed = false;
	std::vector<PenumbraLine> penumbra_lines;
};

/// The error of one light's mask against its reference, as the viewport sees it; filled by
/// ErrorMeter.
struct ErrorState {
	static constexpr uint32_t SAMPLE_COUNTS[] = { 256, 1024, 4096, 9216 };
	bool is_shown = false;		  // the panel is visible
	bool is_stopped = false;	  // by the user
	uint32_t sample_count = 1024; // target of the refinement, rays per pixel
	std::string refusal;		  // why there is no result
	std::string light;
	std::string technique; // technique of the light, chosen or by default
	MaskImage mask;
	ReferenceRound round;							// of the reference
	std::shared_ptr<const ReferenceMask> reference; // null: not yet
	uint64_t reference_hash = 0; // compute_reference_hash of what is traced; 0: nothing
	std::optional<MaskMetrics> metrics;
	MaskTiming cost;
	bool is_tracing = false;
	float progress = 0; // of the running round, 0..1, and its rays per pixel
	uint32_t round_sample_count = 0;
	void *mask_texture = nullptr; // ImTextureID; null: none yet
	void *reference_texture = nullptr;
	void *error_texture = nullptr;
};

/// A command requested by a button or a key; executed once a frame, after the panels.
enum class EditorCommand {
	NONE,
	SHOW_OPEN_MENU,
	OPEN,
	SAVE,
	UNDO,
	REDO,
	FRAME,
	PLAY,
	PLAY_ANIMATION,
	DUPLICATE,
	DELETE,
	READ_PAGE,
	QUIT
};

/// State that tests wait for, and that benchmarks read.
struct EditorProgress {
	uint64_t frame = 0;		  // frame counter
	uint32_t image_count = 0; // full-resolution images drawn so far
	bool is_resting = false;  // nothing waits to be drawn
	/// Latency in ms from each input that changed the scene to the frame that shows it.
	const std::vector<double> &answers_ms;
};

/// The state that all panels share. They change the scene only through the document.
struct EditorContext {
	EditorDocument &document;
	const DeviceInfo &device;
	ViewportState viewport;
	/// Result of the last image.
	RenderResult shown;
	double shown_ms = 0; // wall time
	bool is_image_coarse = false;
	void *image = nullptr;			// ImTextureID; null: none yet
	void *compared_image = nullptr; // the same for ViewportState::compared_technique
	glm::uvec2 image_size_px = glm::uvec2(0);
	ErrorState error;
	/// The last failure or action, for the status bar.
	std::string status;
	bool is_status_error = false;
	std::vector<std::string> messages; // errors and warnings, oldest first
	/// By shader: why its last change is not in use.
	std::map<std::string, std::string> shader_errors;
	std::string inspector_filter;
	EditorCommand command = EditorCommand::NONE;
	/// For EditorCommand::READ_PAGE, relative to the folder above the program's bin.
	std::string requested_page;
	bool shows_open_menu = false;	 // opens the menu of scenes
	std::filesystem::path open_path; // for EditorCommand::OPEN
	std::vector<std::string> recent; // recently opened scenes, newest first
	std::string shown_tab;			 // open tab of the bar below the viewport
	std::string requested_tab;		 // tab to open; cleared once it is open
	uint32_t dragged_handle = 0;	 // ImGuiID of a gizmo's handle; 0: none
	/// Rectangles of widgets in the window, by name: left, top, right, bottom in pixels. For tests.
	std::map<std::string, glm::vec4> items;

	void set_status(std::string p_text) {
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
	/// Returns the light in question: the selected one, else the first that casts a shadow. Null:
	/// none.
	const Light3D *find_light() const;
	std::string find_light_name() const; // empty: none
	/// Builds a snapshot of the scene as the viewport's camera sees it.
	std::shared_ptr<const SceneSnapshot> build_viewport_snapshot() const;
	/// Records the rectangle of the last drawn widget.
	void note_item(const std::string &p_name);
	/// Begins a tab of the bar below the viewport; if it returns true, the caller must end it.
	/// p_addition: text after the name.
	bool begin_tab(const char *p_name, const std::string &p_addition = {});
	/// Draws a tab, with p_draw for its contents.
	void draw_tab(const char *p_name, const std::function<void()> &p_draw,
			const std::string &p_addition = {});
	/// Formats the rectangles and the progress as JSON.
	std::string describe_items(const EditorProgress &p_progress) const;
	/// Runs a user's action; an Error is shown as the status.
	template <typename Action> void attempt(const Action &p_action) {
		viewport.needs_redraw = true; // even after a failure, which may have changed something
		try {
			p_action();
		} catch (const std::exception &failure) {
			complain(describe_failure(failure));
		}
	}
};

/// ImGuiWindowFlags of every panel: the layout sets its position.
extern const int PANEL_FLAGS;

struct EditorLayout;
/// Draws all panels over the whole window.
void draw_layout(EditorContext &r_context, EditorLayout &r_layout);

// The panels; each draws its window with Dear ImGui.
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
