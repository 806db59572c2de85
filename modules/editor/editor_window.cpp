#include "modules/editor/editor_window.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"
#include "modules/desktop/window.h"
#include "modules/editor/editor_context.h"
#include "modules/editor/editor_session.h"
#include "modules/editor/editor_settings.h"
#include "modules/editor/error_meter.h"
#include "modules/editor/shader_reloader.h"
#include "modules/editor/status_sink.h"
#include "modules/editor/ui_context.h"
#include "modules/editor/ui_renderer.h"
#include "modules/editor/viewport_guides.h"
#include "modules/editor/viewport_renderer.h"
#include "modules/render_graph/transient_pool.h"
#include "modules/renderer/present_pass.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <chrono>
#include <fstream>
#include <thread>

namespace gnomon {

namespace {

using Clock = EditorDocument::Clock;

const std::chrono::milliseconds MIN_FRAME_TIME{ 16 };
const uint32_t QUIET_FRAME_COUNT = 3; // frames without changes until EditorProgress::is_resting

const char *const WINDOW_ADVICE =
		"The editor needs a window: set DISPLAY to a display with Vulkan.";

/// Returns the command of a keyboard shortcut; NONE: the key is not a shortcut. The shortcuts
/// follow Godot and Blender; see doc/editor.md.
EditorCommand find_command(const Window::KeyPress &p_press) {
	const bool has_control = (p_press.modifiers & GLFW_MOD_CONTROL) != 0;
	const bool has_shift = (p_press.modifiers & GLFW_MOD_SHIFT) != 0;
	switch (p_press.key) {
		case GLFW_KEY_O:
			return has_control ? EditorCommand::SHOW_OPEN_MENU : EditorCommand::NONE;
		case GLFW_KEY_S:
			return has_control ? EditorCommand::SAVE : EditorCommand::NONE;
		case GLFW_KEY_Z:
			return !has_control ? EditorCommand::NONE
					: has_shift ? EditorCommand::REDO
								: EditorCommand::UNDO;
		case GLFW_KEY_Y:
			return has_control ? EditorCommand::REDO : EditorCommand::NONE;
		case GLFW_KEY_D:
			return has_control ? EditorCommand::DUPLICATE : EditorCommand::NONE;
		case GLFW_KEY_F:
			return has_control ? EditorCommand::NONE : EditorCommand::FRAME;
		case GLFW_KEY_DELETE:
			return EditorCommand::DELETE;
		case GLFW_KEY_F5:
			return EditorCommand::PLAY;
		case GLFW_KEY_SPACE:
			return EditorCommand::PLAY_ANIMATION;
		case GLFW_KEY_Q:
			return has_control ? EditorCommand::QUIT : EditorCommand::NONE;
		default:
			return EditorCommand::NONE;
	}
}

/// The editor of one scene, with its window and GPU device.
class Editor {
public:
	Editor(const EditorOptions &p_options, const std::filesystem::path &p_path,
			EditorSettings &r_settings) :
			options(p_options),
			settings(r_settings), document(p_path, p_options.stage),
			window("Gnomon", r_settings.window_size_px, WINDOW_ADVICE),
			device(create_rendering_device(make_device_options())),
			swapchain(window.create_swapchain(*device)), renderer(*device), transients(*device),
			ui_context(window), ui(*device), viewport_renderer(*device, renderer),
			error_meter(*device, renderer),
			shaders(*device, p_options.shaders), context{ document, device->get_info() },
			session(context, p_options.program) {
		session.move_to_scene_camera();
		document.set_autosave_interval(std::chrono::seconds(settings.autosave_s));
		settings.add_recent(document.get_path());
		context.recent = settings.recent;
		context.viewport.shows_penumbra = settings.shows_penumbra;
		context.error.sample_count = settings.sample_count;
		context.requested_tab = settings.tab;
		if (document.get_failure().empty()) {
			const std::string &staged = document.get_staged();
			context.set_status(text("Opened ", document.get_path().filename().string(),
					staged.empty() ? "" : ". ", staged));
		} else {
			context.requested_tab = "Messages";
		}
	}
	~Editor() {
		try {
			device->wait_idle();
		} catch (const std::exception &) {
			// The device is lost, which was reported when it happened.
		}
	}
	Editor(const Editor &) = delete;
	Editor &operator=(const Editor &) = delete;

	/// Runs until the window is closed. Returns the scene to open next; empty: none.
	std::filesystem::path run() {
		try {
			loop();
			save_settings();
			return session.get_next_path();
		} catch (...) {
			try {
				document.save_recovery();
			} catch (const std::exception &error) {
				log_error("Changes cannot be saved in the recovery file: ", error.what());
			}
			throw;
		}
	}

private:
	void loop() {
		uint32_t drawn_count = 0;
		Clock::time_point last_start = Clock::now();
		const auto is_done = [&] {
			return session.is_closed() ||
					(options.frame_count > 0 && drawn_count >= options.frame_count);
		};
		while (!is_done()) {
			const Clock::time_point start = Clock::now();
			const double elapsed_s = std::chrono::duration<double>(start - last_start).count();
			last_start = start;
			if (!window.poll()) {
				window.keep_open();
				session.close();
			}
			if (window.get_size_px().x == 0 || window.get_size_px().y == 0) {
				document.autosave(Clock::now());
				session.close_if_unchanged();
				std::this_thread::sleep_for(MIN_FRAME_TIME);
				continue;
			}
			session.check_file(start);
			if (shaders.update(context, start)) {
				viewport_renderer.clear_caches();
				error_meter.forget_cost();
			}
			if (document.get_timeline().advance(elapsed_s)) {
				context.viewport.is_moving = true;
				context.viewport.needs_redraw = true;
			}
			// User input is handled before the image is drawn, so that this frame shows its effect.
			build_panels();
			session.run_command();
			const bool is_changed = seen_serial != document.get_history().get_serial();
			seen_serial = document.get_history().get_serial();
			draw_images();
			show_frame();
			if (is_changed && !options.items.empty()) {
				answers_ms.push_back(
						std::chrono::duration<double, std::milli>(Clock::now() - start).count());
			}
			write_items();
			document.autosave(Clock::now());
			++drawn_count;
			std::this_thread::sleep_until(start + MIN_FRAME_TIME);
		}
	}

	void draw_images() {
		viewport_renderer.update(context);
		guides.update(context, viewport_renderer.get_drawn_count());
		// The error needs full resolution. While an animation plays, this stops the measurement.
		if (viewport_renderer.is_sharp() || document.get_timeline().is_playing()) {
			error_meter.update(context, viewport_renderer.get_sharp_count());
		}
		for (const std::string &line : sink.take()) {
			context.report_error(line);
		}
	}

	/// Stores the window's state in the user's settings.
	void save_settings() {
		if (const glm::uvec2 size_px = window.get_size_px(); size_px.x > 0 && size_px.y > 0) {
			settings.window_size_px = size_px;
		}
		settings.tab = context.shown_tab;
		settings.sample_count = context.error.sample_count;
		settings.shows_penumbra = context.viewport.shows_penumbra;
		settings.save();
	}

	DeviceOptions make_device_options() const {
		DeviceOptions device_options;
		device_options.device = options.device;
		device_options.validation = options.validation;
		device_options.needs_surface = true;
		device_options.instance_extensions = Window::get_instance_extensions();
		return device_options;
	}

	/// Returns the ImTextureID of the texture that p_get returns, or null if there is none yet.
	template <typename Get> void *show(const Get &p_get) {
		return p_get() ? ui.add_texture(p_get) : nullptr;
	}

	void build_panels() {
		context.image = show([this] { return viewport_renderer.get_image(); });
		context.compared_image = show([this] { return viewport_renderer.get_compared_image(); });
		ErrorState &error = context.error;
		error.mask_texture = show([this] { return error_meter.get_mask_texture(); });
		error.reference_texture = show([this] { return error_meter.get_reference_texture(); });
		error.error_texture = show([this] { return error_meter.get_error_texture(); });
		ui_context.begin_frame();
		read_shortcuts();
		draw_layout(context, settings.layout);
		session.draw_dialogs();
		ImGui::Render();
		window.set_title(text(document.get_path().filename().string(),
				document.is_changed() ? " * - Gnomon" : " - Gnomon"));
	}

	void show_frame() {
		const glm::uvec2 size_px = window.get_size_px();
		RenderGraph graph(*device, transients);
		const RGTexture target = graph.create_texture({ "editor", Format::RGBA8_UNORM, size_px,
				/*layer_count=*/1, TextureUsage::COLOR_ATTACHMENT | TextureUsage::SAMPLED });
		graph.add_pass("editor background").color(target, LoadOp::CLEAR).execute([](PassContext &) {
		});
		ui.add_pass(graph, target, *ImGui::GetDrawData());
		add_present_pass(graph, target, [&] { return swapchain->acquire(size_px); });
		graph.execute(RenderGraph::Mode::QUEUE);
	}

	/// Writes the widgets' rectangles and the progress, for tests.
	void write_items() {
		if (options.items.empty()) {
			return;
		}
		const bool is_quiet = !context.viewport.needs_redraw && !context.viewport.pick &&
				!context.is_image_coarse && document.get_selected() == last_selected &&
				!document.get_timeline().is_playing();
		last_selected = document.get_selected();
		quiet_count = is_quiet ? quiet_count + 1 : 0;
		const std::string written =
				context.describe_items({ ++frame, viewport_renderer.get_sharp_count(),
						quiet_count >= QUIET_FRAME_COUNT, answers_ms });
		// Writes atomically, but without waiting for the disk, unlike save_file_atomically.
		const std::filesystem::path temporary_path = options.items.string() + ".new";
		std::ofstream stream(temporary_path);
		stream << written;
		stream.close();
		if (std::error_code code; stream) {
			// If renaming fails, the next frame writes the file again.
			std::filesystem::rename(temporary_path, options.items, code);
		}
		context.items.clear();
	}

	void read_shortcuts() {
		if (ImGui::GetIO().WantTextInput || session.is_prompting()) {
			return;
		}
		for (const Window::KeyPress &press : window.get_key_presses()) {
			const EditorCommand command = find_command(press);
			// During keyboard navigation, Space presses the focused widget.
			if (command == EditorCommand::PLAY_ANIMATION && ImGui::GetIO().NavVisible) {
				continue;
			}
			context.command = command != EditorCommand::NONE ? command : context.command;
		}
	}

	const EditorOptions &options;
	EditorSettings &settings;
	StatusSink sink; // declared before the document, to collect the errors of opening the scene
	EditorDocument document;
	Window window;
	std::unique_ptr<RenderingDevice> device;
	std::unique_ptr<Swapchain> swapchain;
	Renderer renderer;
	TransientPool transients;
	UiContext ui_context;
	UiRenderer ui;
	ViewportRenderer viewport_renderer;
	ErrorMeter error_meter;
	ViewportGuides guides;
	ShaderReloader shaders;
	EditorContext context;
	EditorSession session;
	uint64_t frame = 0;
	const Node3D *last_selected = nullptr; // only compared, never dereferenced
	uint64_t seen_serial = 0;			   // UndoHistory::get_serial of the last frame
	std::vector<double> answers_ms;		   // see EditorProgress
	uint32_t quiet_count = 0;			   // successive frames without changes
};

} // namespace

void run_editor(const EditorOptions &p_options) {
	EditorSettings settings = EditorSettings::load();
	std::filesystem::path path = p_options.path;
	if (path.empty()) {
		path = settings.find_recent();
		if (path.empty()) {
			fail("There is no recent scene that still exists. Name a project or a scene: gnomon "
				 "edit PROJECT.");
		}
	}
	while (!path.empty()) {
		path = Editor(p_options, path, settings).run();
		for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
			if (!module.is_enabled && module.can_disable) {
				// Undoes this project's choice; the next project disables its own modules.
				ModuleRegistry::set_enabled(module.name, true);
			}
		}
	}
}

} // namespace gnomon
