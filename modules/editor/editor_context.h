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

/// Where the user has clicked.
struct ViewportPick {
	glm::dvec3 origin_world = glm::dvec3(0.0);
	glm::dvec3 direction_world = glm::dvec3(0.0);
};

/// What the viewport shows, and how.
struct ViewportState {
	OrbitCamera camera;
	std::string debug_view;				// empty: the image itself
	glm::uvec2 size_px = glm::uvec2(0); // requested by the panel
	bool is_moving = false;				// a coarser image will do
	bool needs_redraw = true;			// something has changed since the last one
	/// Of the light in question, other than the image itself: "mask", "error", the technique's own.
	std::vector<std::string> debug_views;
	bool wants_debug_views = false; // that list again
	/// A technique's id: right of the line the light in question has that one. Empty: no line.
	std::string compared_technique;
	float compared_from = 0.5f; // where the line is, a share of the width
	std::optional<ViewportPick> pick;
	bool shows_penumbra = true; // of the selected light
	bool is_guide_changed = false;
	std::vector<PenumbraLine> penumbra_lines;
};

/// How far one light's mask is from its reference, as the viewport sees it. ErrorMeter fills it.
struct ErrorState {
	static constexpr uint32_t SAMPLE_COUNTS[] = { 256, 1024, 4096, 9216 };
	bool is_shown = false;		  // somebody looks
	bool is_stopped = false;	  // by the user
	uint32_t sample_count = 1024; // rays a pixel that are requested in the end
	std::string refusal;		  // why there is nothing
	std::string light;
	std::string technique; // that it has, by choice or by default
	MaskImage mask;
	ReferenceRound round;							// of the reference
	std::shared_ptr<const ReferenceMask> reference; // null: not yet
	uint64_t reference_hash = 0; // compute_reference_hash of what is traced; 0: nothing
	std::optional<MaskMetrics> metrics;
	MaskTiming cost;
	bool is_tracing = false;
	float progress = 0; // of the round under way, and its rays a pixel
	uint32_t round_sample_count = 0;
	void *mask_texture = nullptr; // ImTextureID; null: none yet
	void *reference_texture = nullptr;
	void *error_texture = nullptr;
};

/// What a button or a key requests; done once a frame, after the panels.
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

/// What a test waits for, and a benchmark reads.
struct EditorProgress {
	uint64_t frame = 0;		  // counts
	uint32_t image_count = 0; // sharp ones that were drawn
	bool is_resting = false;  // nothing waits to be drawn
	/// From each input that changed the scene to the frame that shows it.
	const std::vector<double> &answers_ms;
};

/// What all panels share. They change the scene through the document alone.
struct EditorContext {
	EditorDocument &document;
	const DeviceInfo &device;
	ViewportState viewport;
	/// Of the last frame.
	RenderResult shown;
	double shown_ms = 0; // wall time
	bool is_image_coarse = false;
	void *image = nullptr;			// ImTextureID; null: none yet
	void *compared_image = nullptr; // the same, of ViewportState::compared_technique
	glm::uvec2 image_size_px = glm::uvec2(0);
	ErrorState error;
	/// What went wrong or was done last, for the status bar.
	std::string status;
	bool is_status_error = false;
	std::vector<std::string> messages;				  // errors and warnings, the newest last
	std::map<std::string, std::string> shader_errors; // by shader: why its last change is not used
	std::string inspector_filter;
	EditorCommand command = EditorCommand::NONE;
	std::string requested_page;		 // of EditorCommand::READ_PAGE, from the program's folder
	bool shows_open_menu = false;	 // opens the menu of scenes
	std::filesystem::path open_path; // of EditorCommand::OPEN
	std::vector<std::string> recent; // scenes that were open, the newest first
	std::string shown_tab;			 // of the bar below the viewport
	std::string requested_tab;		 // is to be shown; empty once it is
	uint32_t dragged_handle = 0;	 // ImGuiID of a gizmo's handle; 0: none
	/// Where widgets are in the window, by name: left, top, right, bottom in pixels. For tests.
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
	/// The light in question: the selected one, else the first that casts a shadow. Null: none.
	const Light3D *find_light() const;
	std::string find_light_name() const; // empty: none
	/// The scene as the viewport's camera sees it.
	std::shared_ptr<const SceneSnapshot> build_viewport_snapshot() const;
	/// Notes where the widget is that was drawn last.
	void note_item(const std::string &p_name);
	/// Of the bar below the viewport; the caller ends it when it is true. p_addition: shown behind
	/// the name.
	bool begin_tab(const char *p_name, const std::string &p_addition = {});
	/// As begin_tab, with all that p_draw shows.
	void draw_tab(const char *p_name, const std::function<void()> &p_draw,
			const std::string &p_addition = {});
	/// These positions, and what tests and benchmarks wait for, as JSON.
	std::string describe_items(const EditorProgress &p_progress) const;
	/// Runs what a user requested; an Error becomes the status.
	template <typename Action> void attempt(const Action &p_action) {
		viewport.needs_redraw = true; // also of what was done half
		try {
			p_action();
		} catch (const std::exception &failure) {
			complain(describe_failure(failure));
		}
	}
};

/// ImGuiWindowFlags of every panel: the layout gives it its position.
extern const int PANEL_FLAGS;

struct EditorLayout;
/// All panels, over the whole window.
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
