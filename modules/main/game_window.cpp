#include "modules/main/game_window.h"

#include "modules/core/log.h"
#include "modules/desktop/window.h"
#include "modules/main/fly_camera.h"
#include "modules/main/overlay_text.h"
#include "modules/main/run_part.h"
#include "modules/scene/frame_snapshots.h"
#include "modules/shadows/shadow_registry.h"

#include <GLFW/glfw3.h>

#include <chrono>
#include <cstdio>

namespace gnomon {

namespace {

/// Speed of the fly camera in scene sizes per second: it crosses any scene in a few seconds.
constexpr double SPEED_PER_SCENE_SIZE = 0.4;
constexpr double ROTATION_RAD_PER_PX = 0.004; // per pixel of mouse drag
constexpr double LIGHT_SIZE_FACTOR = 1.15;	  // factor of the light size per key press
constexpr size_t MAX_SHOWN_PASSES = 24;		  // with times in the overlay; others are omitted

std::string format_milliseconds(const char *p_name, double p_milliseconds) {
	char line[128];
	std::snprintf(line, sizeof(line), "%8.2f ms  %.100s", p_milliseconds, p_name);
	return line;
}

/// The state that the keys change.
struct GameState {
	Scene &scene;
	RenderRequest &request;
	AnimationPlayback playback;
	bool has_reference = false;
	bool shows_text = true;
	SceneChange change = SceneChange::ANY; // since the last frame
	/// Debug view that key V selects ("mask" or "error"); empty: the view of --debug-view, if any.
	std::string shown;

	/// Cycles through no override (each light's own technique) and all registered techniques.
	void choose_next_technique() {
		const std::vector<ShadowTechniqueInfo> &all = ShadowRegistry::get_all();
		size_t next = 0;
		while (next < all.size() && !request.technique_override.empty() &&
				all[next].id != request.technique_override) {
			++next;
		}
		next += request.technique_override.empty() ? 0 : 1;
		request.technique_override = next < all.size() ? all[next].id : std::string();
	}

	void scale_light_sizes(double p_factor) {
		const PropertyList &list = Light3D::get_property_list();
		for (Light3D *light : scene.find_nodes<Light3D>()) {
			const char *name =
					light->type == LightType::DIRECTIONAL ? "light_angular_distance" : "light_size";
			const PropertyValue value = get_float(list, light->properties, name) * p_factor;
			if (check_property(*list.find(name), value).empty()) {
				light->properties[name] = value;
				change = SceneChange::ANY;
			}
		}
	}

	void press(int p_key, Window &r_window) {
		switch (p_key) {
			case GLFW_KEY_ESCAPE:
				r_window.close();
				break;
			case GLFW_KEY_T:
			case GLFW_KEY_TAB:
				choose_next_technique();
				break;
			case GLFW_KEY_V:
				shown = shown.empty() ? "mask" : shown == "mask" && has_reference ? "error" : "";
				break;
			case GLFW_KEY_SPACE:
				playback.is_playing = !playback.is_playing;
				break;
			case GLFW_KEY_F1:
				shows_text = !shows_text;
				break;
			case GLFW_KEY_EQUAL:
			case GLFW_KEY_KP_ADD:
				scale_light_sizes(LIGHT_SIZE_FACTOR);
				break;
			case GLFW_KEY_MINUS:
			case GLFW_KEY_KP_SUBTRACT:
				scale_light_sizes(1 / LIGHT_SIZE_FACTOR);
				break;
			default:
				break;
		}
	}
};

void fly(FlyCamera &r_camera, const Window &p_window, double p_seconds) {
	const auto axis = [&](int p_positive, int p_negative) {
		return double(p_window.is_down(p_positive)) - double(p_window.is_down(p_negative));
	};
	const glm::dvec2 drag_px = p_window.get_drag_px();
	r_camera.rotate(-drag_px.x * ROTATION_RAD_PER_PX, -drag_px.y * ROTATION_RAD_PER_PX);
	r_camera.move({ axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
						  axis(GLFW_KEY_S, GLFW_KEY_W) },
			p_seconds, p_window.is_down(GLFW_KEY_LEFT_SHIFT));
}

std::vector<std::string> describe_frame(const RenderRequest &p_request, const DeviceInfo &p_device,
		const RenderResult &p_last, double p_frame_seconds) {
	std::vector<std::string> lines = { p_device.name,
		"technique: " +
				(p_request.technique_override.empty() ? "each light's own"
													  : p_request.technique_override),
		format_milliseconds("frame, wall", p_frame_seconds * 1e3),
		format_milliseconds("frame, GPU", p_last.gpu_ms) };
	for (size_t index = 0; index < p_last.timings.size() && index < MAX_SHOWN_PASSES; ++index) {
		const PassTiming &timing = p_last.timings[index];
		lines.push_back(format_milliseconds(timing.name.c_str(), timing.get_cost_ms()));
	}
	lines.push_back("W A S D Q E, right mouse: fly   T: technique   +/-: light size");
	lines.push_back("V: mask, error   Space: pause   F1: text   Esc: end");
	return lines;
}

} // namespace

RenderResult run_in_window(Scene &r_scene, glm::uvec2 &r_size_px, const RunOptions &p_options,
		const CommonOptions &p_common) {
	const Camera3D &start = choose_camera(r_scene, p_options.camera);
	Window window("Gnomon", r_size_px, "Use --headless (with --capture FILE), or set DISPLAY.");
	DeviceOptions device_options;
	device_options.needs_surface = true;
	device_options.instance_extensions = Window::get_instance_extensions();
	const std::unique_ptr<RenderingDevice> device = create_device(p_common, device_options);
	const std::unique_ptr<Swapchain> swapchain = window.create_swapchain(*device);
	Renderer renderer(*device);

	Camera3D camera;
	camera.name = start.name;
	camera.vertical_fov_rad = start.vertical_fov_rad;
	camera.near_m = start.near_m;
	const double scene_size_m = build_snapshot(r_scene, start)->scene_size_m;
	FlyCamera fly_camera(start, scene_size_m * SPEED_PER_SCENE_SIZE);
	RenderRequest request;
	request.technique_override = p_options.technique;
	request.antialiasing = p_options.antialiasing.value_or(1); // `gnomon run` has set it
	request.mode = RenderGraph::Mode::QUEUE;
	const std::shared_ptr<const ReferenceMask> &reference = p_options.reference;
	request.debug_view = p_options.debug_view;
	request.needs_debug_view = true;
	request.reference = reference;
	GameState state{ r_scene, request, p_options.playback, reference != nullptr };
	RenderResult result;
	std::chrono::steady_clock::time_point last = std::chrono::steady_clock::now();
	uint32_t drawn_count = 0;
	const bool has_files = !p_options.capture.empty() || !p_options.dot.empty();
	bool has_drawn_last = false;
	// So that --capture and --dot also work if the window is closed before its first frame.
	fly_camera.apply(camera);
	state.playback.advance(r_scene, 0.0);
	FrameSnapshots snapshots;
	request.scene = snapshots.build(r_scene, camera, SceneChange::ANY);
	while (window.poll()) {
		const std::chrono::steady_clock::time_point now = std::chrono::steady_clock::now();
		const double seconds = std::chrono::duration<double>(now - last).count();
		last = now;
		for (const Window::KeyPress &press : window.get_key_presses()) {
			state.press(press.key, window);
		}
		fly(fly_camera, window, seconds);
		fly_camera.apply(camera);
		state.change = std::max(
				state.change, state.playback.advance(r_scene, drawn_count == 0 ? 0.0 : seconds));
		const glm::uvec2 size_px = window.get_size_px();
		if (size_px.x == 0 || size_px.y == 0) {
			continue; // minimised
		}
		const bool is_last = p_options.frame_count > 0 && drawn_count + 1 >= p_options.frame_count;
		request.scene = snapshots.build(r_scene, camera, state.change);
		state.change = SceneChange::NONE;
		request.size_px = size_px;
		request.acquire_window_image = [&] { return swapchain->acquire(size_px); };
		request.debug_view = state.shown.empty() ? p_options.debug_view : state.shown;
		// In the first frame an unknown debug view is an Error. Later a view may disappear because
		// the technique or the lights change; then the lit image is shown.
		request.needs_debug_view = drawn_count == 0;
		// A reference mask of another size, too, is an Error in the first frame and is ignored
		// after the window was resized.
		const bool fits = reference && (drawn_count == 0 || reference->size_px == size_px);
		request.reference = fits ? reference : nullptr;
		request.wants_image = is_last && !p_options.capture.empty();
		request.wants_graph = is_last && !p_options.dot.empty();
		request.overlay = state.shows_text
				? make_overlay_text(describe_frame(request, device->get_info(), result, seconds),
						  window.get_scale())
				: std::vector<OverlayVertex>();
		result = renderer.render(request);
		r_size_px = size_px;
		++drawn_count;
		if (is_last) {
			has_drawn_last = true;
			break;
		}
	}
	if (has_files && !has_drawn_last) {
		// The window was closed after a frame that was drawn without the image and the graph, so
		// it is drawn again for the files.
		request.size_px = r_size_px;
		request.acquire_window_image = nullptr;
		request.wants_image = !p_options.capture.empty();
		request.wants_graph = !p_options.dot.empty();
		result = renderer.render(request);
	}
	device->wait_idle();
	return result;
}

// Declared in commands.h.
void initialize_desktop_part() {
	RunPartRegistry::add({ DESKTOP_PART, &run_in_window });
}

void uninitialize_desktop_part() {
	RunPartRegistry::remove(DESKTOP_PART);
}

} // namespace gnomon
