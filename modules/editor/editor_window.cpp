#include "modules/editor/editor_window.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"
#include "modules/core/project_scene.h"
#include "modules/desktop/window.h"
#include "modules/editor/editor_context.h"
#include "modules/editor/editor_keys.h"
#include "modules/editor/editor_layout.h"
#include "modules/editor/editor_question.h"
#include "modules/editor/error_meter.h"
#include "modules/editor/game_process.h"
#include "modules/editor/picture_maker.h"
#include "modules/editor/shader_reloader.h"
#include "modules/editor/status_sink.h"
#include "modules/editor/ui_context.h"
#include "modules/editor/ui_renderer.h"
#include "modules/editor/viewport_guides.h"
#include "modules/render_graph/transient_pool.h"

#include <imgui.h>

#include <chrono>
#include <thread>

namespace gnomon {

namespace {

using Clock = EditorDocument::Clock;

const std::chrono::milliseconds FRAME{ 16 };
const std::chrono::seconds FILE_CHECK_INTERVAL{ 1 };
const uint32_t QUIET_FRAME_COUNT = 3; // after which the window shows all that there is

class Editor {
public:
	Editor(const EditorOptions &p_options, const std::filesystem::path &p_path,
			EditorSettings &r_settings) :
			options(p_options),
			settings(r_settings), document(p_path),
			window("Gnomon", r_settings.window_size_px, "The editor needs one: set DISPLAY."),
			device(RenderingDevice::create(make_device_options())),
			swapchain(*device, window.get_create_surface()), renderer(*device), transients(*device),
			ui_context(window), ui(*device), pictures(*device, renderer),
			error_meter(*device, renderer),
			shaders(*device, p_options.shaders), context{ document, device->get_info() } {
		look_as_scene();
		asks_to_recover = document.has_recovery();
		settings.add_recent(document.get_path());
		context.recent = settings.recent;
		context.viewport.shows_penumbra = settings.shows_penumbra;
		context.error.sample_count = settings.sample_count;
		context.wanted_tab = settings.tab;
		if (document.get_failure().empty()) {
			context.say(text("Opened ", document.get_path().string()));
		} else {
			context.wanted_tab = "Messages";
		}
	}
	~Editor() {
		try {
			device->wait_idle();
		} catch (const std::exception &) {
			// The device is lost, which was told when it happened.
		}
	}
	Editor(const Editor &) = delete;
	Editor &operator=(const Editor &) = delete;

	/// Until the window is closed. Returns what is to be opened next; empty: nothing.
	std::filesystem::path run() {
		try {
			loop();
			remember();
			return next_path;
		} catch (...) {
			try {
				document.save_aside();
			} catch (const std::exception &error) {
				log_error("Changes cannot be saved aside: ", error.what());
			}
			throw;
		}
	}

private:
	void loop() {
		uint32_t drawn_count = 0;
		while (!is_done) {
			const Clock::time_point start = Clock::now();
			if (!window.poll()) {
				window.keep_open();
				is_closing = true;
			}
			if (window.get_size_px().x == 0 || window.get_size_px().y == 0) {
				document.autosave(Clock::now());
				is_done |= is_closing && !document.is_changed();
				std::this_thread::sleep_for(FRAME);
				continue;
			}
			follow_file(start);
			if (shaders.update(context, start)) {
				pictures.forget_kept();
			}
			pictures.update(context);
			guides.update(context, pictures.get_drawn_count());
			if (pictures.is_sharp()) {
				error_meter.update(context, pictures.get_count());
			}
			for (const std::string &line : sink.take()) {
				context.complain(line);
			}
			draw_frame();
			run_command();
			write_items();
			document.autosave(Clock::now());
			++drawn_count;
			is_done |= options.frame_count > 0 && drawn_count >= options.frame_count;
			std::this_thread::sleep_until(start + FRAME);
		}
	}

	void remember() {
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

	/// From the scene's first camera, or so that all of it is seen.
	void look_as_scene() {
		const std::vector<Camera3D *> cameras = document.get_scene().find_nodes<Camera3D>();
		Bounds bounds;
		context.attempt([&] { bounds = document.compute_selected_bounds(); });
		if (cameras.empty()) {
			context.viewport.camera.frame(bounds);
			return;
		}
		const glm::dvec3 position(cameras.front()->compute_world_from_node()[3]);
		const double distance_m = bounds.is_empty()
				? 5.0
				: glm::length(0.5 * (bounds.minimum + bounds.maximum) - position);
		context.viewport.camera.look_as(*cameras.front(), distance_m);
	}

	/// Another program, such as Blender, may have written the file.
	void follow_file(Clock::time_point p_now) {
		if (p_now < next_file_check) {
			return;
		}
		next_file_check = p_now + FILE_CHECK_INTERVAL;
		if (!document.is_file_newer() || document.is_changed()) {
			asks_to_reload |= document.is_file_newer();
			return;
		}
		context.attempt([&] {
			const bool was_read = document.get_failure().empty();
			document.reload();
			if (!was_read) {
				look_as_scene();
			}
			context.say("The file has changed and was read anew.");
		});
	}

	void draw_frame() {
		const auto show = [&](TextureRID p_texture) {
			return p_texture ? ui.add_texture(p_texture) : nullptr;
		};
		context.picture = show(pictures.get_picture());
		context.compared_picture = show(pictures.get_compared_picture());
		context.error.mask_picture = show(error_meter.get_mask_picture());
		context.error.truth_picture = show(error_meter.get_truth_picture());
		context.error.error_picture = show(error_meter.get_error_picture());
		ui_context.begin_frame();
		read_shortcuts();
		draw_layout(context, settings.layout);
		draw_questions();
		ImGui::Render();
		window.set_title(text(document.get_path().filename().string(),
				document.is_changed() ? " * - Gnomon" : " - Gnomon"));

		const glm::uvec2 size_px = window.get_size_px();
		RenderGraph graph(*device, transients);
		const RGTexture target = graph.create_texture({ "editor", Format::RGBA8_UNORM, size_px, 1,
				TextureUsage::COLOR_ATTACHMENT | TextureUsage::COPY_SOURCE });
		graph.add_pass("editor background").color(target, LoadOp::CLEAR).execute([](PassContext &) {
		});
		ui.add_pass(graph, target, *ImGui::GetDrawData());
		const RGTexture shown =
				graph.import_window_image([&] { return swapchain.acquire(size_px); });
		graph.add_pass("present")
				.reads(target, Access::COPY_READ)
				.writes(shown, Access::COPY_WRITE)
				.execute([=](PassContext &p_context) {
					p_context.commands.blit_texture(p_context.get(target), p_context.get(shown));
				});
		graph.execute(RenderGraph::Mode::QUEUE);
	}

	/// What a test needs to press and to wait for.
	void write_items() {
		if (options.items.empty()) {
			return;
		}
		const bool is_quiet = !context.viewport.needs_picture && !context.viewport.pick &&
				!context.is_picture_coarse && document.get_selected() == last_selected;
		last_selected = document.get_selected();
		quiet_count = is_quiet ? quiet_count + 1 : 0;
		const std::string written =
				context.describe_items(pictures.get_count(), quiet_count >= QUIET_FRAME_COUNT);
		if (written != written_items) {
			save_file_atomically(options.items, std::string_view(written));
			written_items = written;
		}
		context.items.clear();
	}

	void read_shortcuts() {
		if (ImGui::GetIO().WantTextInput || is_asking()) {
			return;
		}
		for (const Window::KeyPress &press : window.get_key_presses()) {
			const EditorCommand command = find_command(press);
			context.command = command != EditorCommand::NONE ? command : context.command;
		}
	}

	bool is_asking() const { return is_closing || asks_to_recover || asks_to_reload; }

	void run_command() {
		const EditorCommand command = std::exchange(context.command, EditorCommand::NONE);
		if (command == EditorCommand::NONE) {
			return;
		}
		context.attempt([&] { run(command); });
	}

	void run(EditorCommand p_command) {
		const bool saves = p_command == EditorCommand::SAVE ||
				(p_command == EditorCommand::PLAY && document.is_changed());
		if (saves && document.is_file_newer()) {
			asks_to_reload = true;
			return;
		}
		Node3D *selected = document.get_selected();
		switch (p_command) {
			case EditorCommand::NONE:
				break;
			case EditorCommand::ASK_TO_OPEN:
				context.asks_to_open = true;
				break;
			case EditorCommand::OPEN:
				next_path = find_project_scene(context.open_path).scene_path;
				if (!std::filesystem::exists(next_path)) {
					fail("Scene ", std::exchange(next_path, {}),
							" does not exist. Check the path.");
				}
				is_closing = true;
				break;
			case EditorCommand::SAVE:
				document.save();
				context.say(text("Saved ", document.get_path().string()));
				break;
			case EditorCommand::UNDO:
				if (const std::string name = document.undo(); !name.empty()) {
					context.say("Undone: " + name);
				}
				break;
			case EditorCommand::REDO:
				if (const std::string name = document.redo(); !name.empty()) {
					context.say("Done again: " + name);
				}
				break;
			case EditorCommand::DUPLICATE:
				if (selected != nullptr) {
					document.duplicate(*selected);
				}
				break;
			case EditorCommand::DELETE:
				if (selected != nullptr) {
					document.remove(*selected);
				}
				break;
			case EditorCommand::FRAME:
				context.viewport.camera.frame(document.compute_selected_bounds());
				break;
			case EditorCommand::PLAY:
				if (document.is_changed()) {
					document.save();
				}
				start_game(options.program, document.get_path());
				context.say("The game runs in a window of its own.");
				break;
			case EditorCommand::QUIT:
				is_closing = true;
				break;
		}
	}

	void draw_questions() {
		if (is_closing && !document.is_changed()) {
			is_done = true;
		} else if (is_closing) {
			is_closing = !draw_question(make_closing_question());
			if (!is_closing && !is_done) {
				next_path.clear(); // cancelled
			}
		} else if (asks_to_recover) {
			asks_to_recover = !draw_question({ "Recover changes?",
					"The editor ended without saving. What was changed was kept aside.", "Recover",
					"Discard", [&] { context.attempt([&] { document.recover(); }); },
					[&] { document.discard_recovery(); } });
		} else if (asks_to_reload) {
			asks_to_reload = !draw_question({ "Read the file anew?",
					"Another program has written the file, and there are changes here.",
					"Read it, drop the changes", "Keep the changes",
					[&] { context.attempt([&] { document.reload(); }); },
					[&] { document.keep_over_file(); } });
		}
	}

	EditorQuestion make_closing_question() {
		const auto save = [&] {
			if (document.is_file_newer()) {
				asks_to_reload = true; // first: which of both is to be saved
				return;
			}
			context.attempt([&] {
				document.save();
				is_done = true;
			});
		};
		const auto drop = [&] {
			document.discard_recovery();
			is_done = true;
		};
		return { "Save the changes?",
			text(document.get_path().filename().string(), " has changes that are not saved."),
			"Save and close", "Close without saving", save, drop, true };
	}

	const EditorOptions &options;
	EditorSettings &settings;
	StatusSink sink; // first: what cannot be read when the scene is opened is told too
	EditorDocument document;
	Window window;
	std::unique_ptr<RenderingDevice> device;
	Swapchain swapchain;
	Renderer renderer;
	TransientPool transients;
	UiContext ui_context;
	UiRenderer ui;
	PictureMaker pictures;
	ErrorMeter error_meter;
	ViewportGuides guides;
	ShaderReloader shaders;
	EditorContext context;
	Clock::time_point next_file_check;
	std::filesystem::path next_path; // to be opened when this ends
	std::string written_items;
	const Node3D *last_selected = nullptr; // compared only
	uint32_t quiet_count = 0;			   // frames without anything to draw anew
	bool asks_to_recover = false;
	bool asks_to_reload = false;
	bool is_closing = false;
	bool is_done = false;
};

} // namespace

void run_editor(const EditorOptions &p_options) {
	EditorSettings settings = EditorSettings::load();
	std::filesystem::path path = p_options.path;
	if (path.empty()) {
		if (settings.recent.empty()) {
			fail("No scene was open before. Name a project or a scene: gnomon edit PROJECT.");
		}
		path = settings.recent.front();
	}
	while (!path.empty()) {
		path = Editor(p_options, path, settings).run();
		for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
			if (!module.is_enabled && module.can_disable) {
				ModuleRegistry::set_enabled(module.name, true); // each project says which it wants
			}
		}
	}
}

} // namespace gnomon
