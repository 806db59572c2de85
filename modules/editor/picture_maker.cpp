#include "modules/editor/picture_maker.h"

#include <algorithm>
#include <exception>

namespace gnomon {

namespace {

const std::chrono::milliseconds REST{ 250 }; // without change, before the picture is sharpened
const uint32_t COARSE_DIVISOR = 2;

} // namespace

void PictureMaker::update(EditorContext &r_context) {
	ViewportState &viewport = r_context.viewport;
	const Clock::time_point now = Clock::now();
	const bool is_slow = r_context.device.type == "CPU";
	if (viewport.needs_picture) {
		last_change = now;
	}
	const bool sharpens = is_coarse && now - last_change > REST;
	if ((!viewport.needs_picture && !sharpens) || viewport.size_px == glm::uvec2(0)) {
		return;
	}
	is_coarse = is_slow && viewport.is_moving && !sharpens;
	viewport.needs_picture = false;
	viewport.is_moving = false;
	try {
		draw(r_context,
				glm::max(viewport.size_px / (is_coarse ? COARSE_DIVISOR : 1u), glm::uvec2(1)));
		sharp_count += is_coarse ? 0 : 1;
	} catch (const std::exception &error) {
		r_context.complain(error.what());
		is_coarse = false;
	}
}

void PictureMaker::draw(EditorContext &r_context, glm::uvec2 p_size_px) {
	const Clock::time_point start = Clock::now();
	Camera3D camera;
	camera.name = "Viewport";
	r_context.viewport.camera.apply(camera);
	OwnedTexture target;
	if (p_size_px != r_context.picture_size_px || !picture) {
		target = OwnedTexture(device,
				device.create_texture({ "viewport", Format::RGBA8_UNORM, p_size_px, 1,
						TextureUsage::SAMPLED | TextureUsage::COPY_TARGET }));
	}
	RenderRequest request;
	request.scene = build_snapshot(r_context.document.get_scene(), camera);
	request.size_px = p_size_px;
	request.debug_view = r_context.viewport.debug_view;
	request.needs_debug_view = false;
	request.picture_target = target ? target.get() : picture.get();
	r_context.shown = renderer.render(request);
	if (target) {
		picture = std::move(target);
		r_context.picture_size_px = p_size_px;
	}
	r_context.shown_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

} // namespace gnomon
