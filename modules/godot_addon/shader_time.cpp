#include "modules/godot_addon/shader_time.h"

#include <bit>
#include <cmath>
#include <cstdint>

namespace gnomon {

namespace {

const uint32_t MAX_UNUSED_FRAMES = 60;
const int SIZE_PX = 2; // of the view; Godot draws none of one pixel
const char SHADER_CODE[] = R"(shader_type canvas_item;
render_mode unshaded, blend_disabled;
void fragment() {
	uint bits = floatBitsToUint(TIME);
	if (FRAGCOORD.x > 1.0) {
		bits >>= 24u;
	}
	COLOR = vec4(uvec4(bits & 255u, (bits >> 8u) & 255u, (bits >> 16u) & 255u, 255u)) / 255.0;
}
)";

godot::RenderingServer get_server() {
	return godot::RenderingServer(godot::find_singleton("RenderingServer"));
}

} // namespace

class ShaderTime::View {
public:
	View() {
		shader = server.shader_create();
		server.shader_set_code(shader, SHADER_CODE);
		material = server.material_create();
		server.material_set_shader(material, shader);
		canvas = server.canvas_create();
		item = server.canvas_item_create();
		server.canvas_item_set_parent(item, canvas);
		server.canvas_item_set_material(item, material);
		server.canvas_item_add_rect(item, { glm::vec2(0.0f), glm::vec2(SIZE_PX) }, glm::vec4(1.0f),
				/*antialiased=*/false);
		viewport = server.viewport_create();
		server.viewport_set_size(viewport, SIZE_PX, SIZE_PX);
		server.viewport_set_disable_3d(viewport, /*disable=*/true);
		server.viewport_attach_canvas(viewport, canvas);
		server.viewport_set_update_mode(viewport, godot::RenderingServer::VIEWPORT_UPDATE_ALWAYS);
		server.viewport_set_active(viewport, /*active=*/true);
	}
	~View() {
		for (const godot::RID rid : { viewport, item, canvas, material, shader }) {
			server.free_rid(rid);
		}
	}
	View(const View &) = delete;
	View &operator=(const View &) = delete;

	/// Returns what it has drawn last; empty: nothing yet.
	std::optional<float> read() const {
		const godot::Ref<godot::Image> image =
				server.texture_2d_get(server.viewport_get_texture(viewport));
		if (!image || image.get_width() != SIZE_PX || image.get_height() != SIZE_PX) {
			return {};
		}
		image.convert(godot::Image::FORMAT_RGBA8);
		const godot::PackedByteArray data = image.get_data();
		const std::span<const uint8_t> bytes = data.get_values();
		if (bytes.size() < size_t(4 * SIZE_PX * SIZE_PX)) {
			return {};
		}
		return std::bit_cast<float>(uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8 |
				uint32_t(bytes[2]) << 16 | uint32_t(bytes[4]) << 24);
	}

private:
	const godot::RenderingServer server = get_server();
	godot::RID shader, material, canvas, item, viewport;
};

ShaderTime::ShaderTime() = default;
ShaderTime::~ShaderTime() = default;

double ShaderTime::use() {
	unused_frames = 0;
	if (!view) {
		view = std::make_unique<View>();
		is_estimated = true; // it may never have been right
	}
	return time_s;
}

void ShaderTime::update() {
	const godot::Engine engine(godot::find_singleton("Engine"));
	// RenderingServer.force_draw() draws without a step, and does not count as a frame.
	const int64_t frame = engine.get_frames_drawn();
	if (frame == drawn_frames) {
		return;
	}
	drawn_frames = frame;
	if (view && is_estimated) {
		correct(engine);
	}
	add_step(engine);
	if (++unused_frames > MAX_UNUSED_FRAMES) {
		view.reset();
	}
}

void ShaderTime::correct(const godot::Engine &p_engine) {
	const std::optional<float> drawn_s = view->read();
	if (!drawn_s || *drawn_s <= 0) {
		return;
	}
	is_estimated = false;
	// Whole steps keep the digits that a float has not.
	const double step_s = p_engine.get_time_scale() /
			double(std::max<int64_t>(1, p_engine.get_physics_ticks_per_second()));
	const double missing_s = double(*drawn_s) - time_s;
	const double whole_s = step_s > 0 ? std::round(missing_s / step_s) * step_s : 0;
	const double rounding_s = 1e-6 + 2e-7 * *drawn_s;
	time_s += std::abs(missing_s - whole_s) <= rounding_s ? whole_s : missing_s;
}

void ShaderTime::add_step(const godot::Engine &p_engine) {
	const auto tree = godot::cast<godot::SceneTree>(p_engine.get_main_loop());
	const godot::Window root = tree ? tree.get_root() : godot::Window();
	if (!root) {
		return;
	}
	if (!is_connected) {
		const godot::Time clock(godot::find_singleton("Time"));
		on_physics_frame = godot::Callable([clock, begin = step_usec](auto) {
			*begin = *begin == 0 ? clock.get_ticks_usec() : *begin;
		});
		tree.connect("physics_frame", on_physics_frame, /*flags=*/0);
		is_connected = true;
	}
	const double process_s = root.get_process_delta_time();
	time_s += process_s;
	const int64_t last_physics_frames =
			std::exchange(physics_frames, p_engine.get_physics_frames());
	const int64_t now_usec = std::exchange(*step_usec, 0);
	const int64_t last_usec = now_usec != 0 ? std::exchange(begin_usec, now_usec) : begin_usec;
	const double scale = p_engine.get_time_scale();
	if (physics_frames - last_physics_frames >= p_engine.get_max_physics_steps_per_frame()) {
		is_estimated = true;
		if (now_usec > 0 && last_usec > 0 && scale > 0) {
			const auto ticks_per_s = double(p_engine.get_physics_ticks_per_second());
			const double elapsed_s = 1e-6 * double(now_usec - last_usec);
			const double skipped = std::round((elapsed_s - process_s / scale) * ticks_per_s);
			time_s += std::max(skipped, 0.0) * scale / ticks_per_s;
		}
	}
	const godot::ProjectSettings settings(godot::find_singleton("ProjectSettings"));
	const double rollover_s =
			settings.get_setting_with_override("rendering/limits/time/time_rollover_secs")
					.to_float();
	if (rollover_s > 0) {
		time_s = std::fmod(time_s, rollover_s);
	}
}

} // namespace gnomon
