#include "modules/editor/editor_window.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/desktop/window.h"
#include "modules/editor/editor_context.h"
#include "modules/editor/editor_layout.h"
#include "modules/editor/picture_maker.h"
#include "modules/editor/ui_renderer.h"
#include "modules/render_graph/transient_pool.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace gnomon {

namespace {

using Clock = EditorDocument::Clock;

const glm::uvec2 START_SIZE_PX(1280, 720);
const std::chrono::milliseconds FRAME{ 16 };
const std::chrono::seconds FILE_CHECK_INTERVAL{ 1 };

/// Dear ImGui for one window.
class UiContext {
public:
	explicit UiContext(Window &p_window) {
		IMGUI_CHECKVERSION();
		ImGui::CreateContext();
		ImGuiIO &io = ImGui::GetIO();
		io.IniFilename = nullptr; // the panels have fixed places
		io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
		const float scale = p_window.get_scale();
		ImFontConfig font;
		font.SizePixels = std::round(13.0f * scale);
		io.Fonts->AddFontDefault(&font);
		ImGui::StyleColorsDark();
		ImGui::GetStyle().ScaleAllSizes(scale);
		ImGui::GetStyle().WindowRounding = 0.0f;
		ImGui_ImplGlfw_InitForOther(p_window.get_handle(), true);
	}
	~UiContext() {
		ImGui_ImplGlfw_Shutdown();
		ImGui::DestroyContext();
	}
	UiContext(const UiContext &) = delete;
	UiContext &operator=(const UiContext &) = delete;
};

/// Errors and warnings of all modules, for the status bar; they may come from any thread.
class StatusSink {
public:
	StatusSink() {
		before = set_log_sink([this](LogLevel p_level, const std::string &p_line) {
			std::fprintf(
					stderr, "%s%s\n", p_level == LogLevel::ERROR ? "ERROR: " : "", p_line.c_str());
			if (p_level != LogLevel::INFO) {
				const std::lock_guard lock(mutex);
				lines.push_back(p_line);
			}
		});
	}
	~StatusSink() { set_log_sink(before); }
	StatusSink(const StatusSink &) = delete;
	StatusSink &operator=(const StatusSink &) = delete;

	/// Those since the last call.
	std::vector<std::string> take() {
		const std::lock_guard lock(mutex);
		return std::exchange(lines, {});
	}

private:
	LogSink before;
	std::mutex mutex;
	std::vector<std::string> lines;
};

class Editor {
public:
	explicit Editor(const EditorOptions &p_options) :
			options(p_options), document(p_options.path),
			window("Gnomon", START_SIZE_PX, "The editor needs one: set DISPLAY."),
			device(RenderingDevice::create(make_device_options())),
			swapchain(*device, window.get_create_surface()), renderer(*device), transients(*device),
			ui_context(window), ui(*device),
			pictures(*device, renderer), context{ document, device->get_info() } {
		look_as_scene();
		asks_to_recover = document.has_recovery();
		context.say(text("Opened ", document.get_path().string()));
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

	void run() {
		try {
			loop();
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
			pictures.update(context);
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
		context.attempt([&] {
			Camera3D start;
			bounds = build_snapshot(document.get_scene(), start)->compute_caster_bounds();
		});
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
			document.reload();
			context.say("The file has changed and was read anew.");
		});
	}

	void draw_frame() {
		context.picture = pictures.get_picture() ? ui.add_texture(pictures.get_picture()) : nullptr;
		ImGui_ImplGlfw_NewFrame();
		ImGui::NewFrame();
		read_shortcuts();
		draw_layout(context, layout);
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
		nlohmann::json places = nlohmann::json::object();
		for (const auto &[name, rectangle] : context.items) {
			places[name] = { rectangle.x, rectangle.y, rectangle.z, rectangle.w };
		}
		const Node3D *selected = document.get_selected();
		const std::string written = nlohmann::json(
				{ { "items", places }, { "selected", selected ? selected->name : "" },
						{ "status", context.status }, { "is_changed", document.is_changed() },
						{ "pictures", pictures.get_count() } })
											.dump();
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

	static EditorCommand find_command(const Window::KeyPress &p_press) {
		const bool has_control = (p_press.modifiers & GLFW_MOD_CONTROL) != 0;
		const bool has_shift = (p_press.modifiers & GLFW_MOD_SHIFT) != 0;
		switch (p_press.key) {
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
			case GLFW_KEY_Q:
				return has_control ? EditorCommand::QUIT : EditorCommand::NONE;
			default:
				return EditorCommand::NONE;
		}
	}

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
				frame_selected();
				break;
			case EditorCommand::PLAY:
				play();
				break;
			case EditorCommand::QUIT:
				is_closing = true;
				break;
		}
	}

	void frame_selected() {
		Camera3D camera;
		const auto snapshot = build_snapshot(document.get_scene(), camera);
		Bounds bounds = snapshot->compute_caster_bounds();
		if (const Node3D *selected = document.get_selected()) {
			const glm::dvec3 place(selected->compute_world_from_node()[3]);
			bounds = Bounds();
			bounds.add(place - glm::dvec3(0.05 * snapshot->scene_size_m));
			bounds.add(place + glm::dvec3(0.05 * snapshot->scene_size_m));
			if (const auto *instance = dynamic_cast<const MeshInstance3D *>(selected)) {
				for (const InstanceSnapshot &one : snapshot->instances) {
					for (const MeshInstance3D::Surface &surface : instance->surfaces) {
						if (one.mesh == surface.mesh &&
								one.world_from_node == selected->compute_world_from_node()) {
							bounds.add(one.bounds_world);
						}
					}
				}
			}
		}
		context.viewport.camera.frame(bounds);
	}

	void play() {
		if (document.is_changed()) {
			document.save();
		}
		const std::string command = text("'", options.program, "' run '",
				document.get_path().string(), "' >/dev/null 2>&1 &");
		if (options.program.find('\'') != std::string::npos ||
				document.get_path().string().find('\'') != std::string::npos ||
				std::system(command.c_str()) != 0) {
			fail("The game cannot be started. Run: ", options.program, " run ",
					document.get_path().string());
		}
		context.say("The game runs in a window of its own.");
	}

	void draw_questions() {
		if (is_closing && !document.is_changed()) {
			is_done = true;
			return;
		}
		if (is_closing) {
			ask(
					"Save the changes?",
					text(document.get_path().filename().string(),
							" has changes that are not saved."),
					"Save and close", "Close without saving",
					[&] {
						document.save();
						is_done = true;
					},
					[&] {
						document.discard_recovery();
						is_done = true;
					},
					is_closing);
		} else if (asks_to_recover) {
			ask(
					"Recover changes?",
					"The editor ended without saving. What was changed was kept aside.", "Recover",
					"Discard", [&] { document.recover(); }, [&] { document.discard_recovery(); },
					asks_to_recover);
		} else if (asks_to_reload) {
			ask(
					"Read the file anew?",
					"Another program has written the file, and there are changes here.",
					"Read it, drop the changes", "Keep the changes", [&] { document.reload(); },
					[&] { document.keep_over_file(); }, asks_to_reload);
		}
	}

	/// A question with two answers, and "Cancel" where the window is to close; r_asks becomes false
	/// with an answer.
	void ask(const char *p_title, const std::string &p_text, const char *p_yes, const char *p_no,
			const std::function<void()> &p_on_yes, const std::function<void()> &p_on_no,
			bool &r_asks) {
		ImGui::OpenPopup(p_title);
		if (!ImGui::BeginPopupModal(p_title, nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
			return;
		}
		ImGui::TextUnformatted(p_text.c_str());
		bool is_answered = false;
		if (ImGui::Button(p_yes)) {
			context.attempt(p_on_yes);
			is_answered = true;
		}
		ImGui::SameLine();
		if (ImGui::Button(p_no)) {
			context.attempt(p_on_no);
			is_answered = true;
		}
		ImGui::SameLine();
		if (&r_asks == &is_closing &&
				(ImGui::Button("Cancel") || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false))) {
			is_answered = true;
		}
		if (is_answered) {
			r_asks = false;
			ImGui::CloseCurrentPopup();
		}
		ImGui::EndPopup();
	}

	const EditorOptions &options;
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
	EditorContext context;
	EditorLayout layout;
	Clock::time_point next_file_check;
	std::string written_items;
	bool asks_to_recover = false;
	bool asks_to_reload = false;
	bool is_closing = false;
	bool is_done = false;
};

} // namespace

void run_editor(const EditorOptions &p_options) {
	Editor(p_options).run();
}

} // namespace gnomon
