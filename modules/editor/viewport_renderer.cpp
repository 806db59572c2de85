#include "modules/editor/viewport_renderer.h"

#include "modules/core/text.h"
#include "modules/shadows/shadow_registry.h"

#include <algorithm>
#include <exception>

namespace gnomon {

namespace {

// Time without a change after which an image of full resolution is drawn.
const std::chrono::milliseconds SHARPEN_DELAY{ 250 };
// The reduced resolution adapts to the time of the last coarse image: its divisor grows above
// SLOW_MS and shrinks below QUICK_MS.
const uint32_t MIN_DIVISOR = 2;
const uint32_t MAX_DIVISOR = 4;
const double QUICK_MS = 25;
const double SLOW_MS = 70;

/// Makes the request for a debug view of the active light (EditorContext::find_light), or for the
/// lit image if p_debug_view is empty or does not exist.
RenderRequest make_request(
		const EditorContext &p_context, glm::uvec2 p_size_px, const std::string &p_debug_view) {
	RenderRequest request;
	request.scene = p_context.build_viewport_snapshot();
	request.size_px = p_size_px;
	request.debug_view = p_debug_view;
	request.needs_debug_view = false;
	request.debug_light = p_context.find_light_name();
	return request;
}

} // namespace

void ViewportRenderer::update(EditorContext &r_context) {
	ViewportState &viewport = r_context.viewport;
	const Clock::time_point now = Clock::now();
	const bool is_slow = r_context.device.type == "CPU";
	const bool needs_light = !viewport.debug_view.empty() || !viewport.compared_technique.empty();
	const std::string light = r_context.find_light_name();
	viewport.needs_redraw |= needs_light && !light.empty() && light != drawn_light;
	if (viewport.needs_redraw) {
		last_change = now;
	}
	if (viewport.wants_debug_views) {
		r_context.attempt([&] { list_debug_views(r_context); });
	}
	const bool sharpens = is_coarse && now - last_change > SHARPEN_DELAY;
	if ((!viewport.needs_redraw && !sharpens) || viewport.size_px == glm::uvec2(0)) {
		return;
	}
	is_coarse = is_slow && viewport.is_moving && !sharpens;
	viewport.needs_redraw = false;
	viewport.is_moving = false;
	try {
		draw(r_context, glm::max(viewport.size_px / (is_coarse ? divisor : 1u), glm::uvec2(1)));
		if (is_coarse && r_context.shown_ms > SLOW_MS) {
			divisor = std::min(divisor + 1, MAX_DIVISOR);
		} else if (is_coarse && r_context.shown_ms < QUICK_MS) {
			divisor = std::max(divisor - 1, MIN_DIVISOR);
		}
	} catch (const std::exception &error) {
		r_context.report_error(describe_failure(error));
		is_coarse = false;
	}
}

void ViewportRenderer::clear_caches() {
	renderer.clear_caches();
	compared_renderer.reset();
}

void ViewportRenderer::draw(EditorContext &r_context, glm::uvec2 p_size_px) {
	const Clock::time_point start = Clock::now();
	const ViewportState &viewport = r_context.viewport;
	const ErrorState &error = r_context.error;
	RenderRequest request = make_request(r_context, p_size_px, viewport.debug_view);
	drawn_light = request.debug_light;
	const LightSnapshot *light = request.scene->find_light(request.debug_light);
	if (error.reference && light != nullptr && light->casts_shadow &&
			compute_reference_hash(*request.scene, *light, p_size_px) == error.reference_hash) {
		request.reference = error.reference;
	}
	r_context.shown = draw_into(image, request, renderer);
	r_context.image_size_px = p_size_px;
	r_context.is_image_coarse = is_coarse;
	++drawn_count;
	sharp_count += is_coarse ? 0 : 1;
	try {
		draw_compared(r_context, request);
	} catch (const std::exception &failure) {
		compared_image.reset(); // it is older than the image next to it
		r_context.report_error(describe_failure(failure));
	}
	r_context.shown_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
	if (!r_context.shown.debug_views.empty()) {
		r_context.viewport.debug_views = r_context.shown.debug_views;
	}
}

/// Draws the scene with the compared technique for the request's debug_light.
void ViewportRenderer::draw_compared(EditorContext &r_context, RenderRequest p_request) {
	std::string &technique = r_context.viewport.compared_technique;
	if (!technique.empty() && ShadowRegistry::find(technique) == nullptr) {
		r_context.report_error(text("Technique \"", technique,
				"\" no longer exists: its module is disabled. Choose another one to compare."));
		technique.clear();
	}
	if (technique.empty()) {
		compared_image.reset();
		compared_renderer.reset();
		return;
	}
	auto scene = std::make_shared<SceneSnapshot>(*p_request.scene);
	scene->lights.edit_all([&](LightSnapshot &r_light) {
		if (r_light.name == p_request.debug_light) {
			r_light.technique_id = technique;
		}
	});
	p_request.scene = scene;
	if (!compared_renderer) {
		compared_renderer = std::make_unique<Renderer>(device);
	}
	draw_into(compared_image, std::move(p_request), *compared_renderer);
}

/// Renders into r_image. It is recreated if its size has changed, and stays unchanged on an Error.
RenderResult ViewportRenderer::draw_into(
		OwnedTexture &r_image, RenderRequest p_request, Renderer &r_renderer) {
	OwnedTexture new_texture;
	if (!r_image || device.get_desc(r_image.get()).size_px != p_request.size_px) {
		new_texture = OwnedTexture(device,
				device.create_texture({ "viewport", Format::RGBA8_UNORM, p_request.size_px,
						/*layer_count=*/1, TextureUsage::SAMPLED | TextureUsage::COPY_TARGET }));
	}
	p_request.image_target = new_texture ? new_texture.get() : r_image.get();
	RenderResult result = r_renderer.render(p_request);
	if (new_texture) {
		r_image = std::move(new_texture);
	}
	return result;
}

/// Updates ViewportState::debug_views. Techniques create their intermediate images only if one is
/// requested, so this renders a small frame that requests one.
void ViewportRenderer::list_debug_views(EditorContext &r_context) {
	const glm::uvec2 LIST_SIZE_PX(32);
	r_context.viewport.wants_debug_views = false;
	r_context.viewport.debug_views =
			renderer.render(make_request(r_context, LIST_SIZE_PX, "mask")).debug_views;
}

} // namespace gnomon
