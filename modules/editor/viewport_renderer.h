#pragma once

#include "modules/editor/editor_context.h"

#include <chrono>
#include <memory>

namespace gnomon {

/// Renders the scene for the viewport when something has changed. On a CPU device the resolution is
/// reduced while something moves; a full-resolution image follows when it rests. Renders a second
/// image if two techniques are compared.
class ViewportRenderer {
public:
	ViewportRenderer(RenderingDevice &p_device, Renderer &p_renderer) :
			device(p_device), renderer(p_renderer) {}

	/// Call it once a frame; renders if needed. An Error is shown in the status bar, and the last
	/// image stays.
	void update(EditorContext &r_context);
	/// Discards the techniques' caches, because the shaders have changed.
	void clear_caches();
	/// RGBA8_UNORM, SAMPLED; empty before the first image.
	TextureRID get_image() const { return image.get(); }
	/// Image of the compared technique; empty if there is none.
	TextureRID get_compared_image() const { return compared_image.get(); }
	/// Returns the number of images drawn so far.
	uint32_t get_drawn_count() const { return drawn_count; }
	/// Returns the number of full-resolution images drawn so far.
	uint32_t get_sharp_count() const { return sharp_count; }
	/// Whether the last image has full resolution.
	bool is_sharp() const { return sharp_count > 0 && !is_coarse; }

private:
	using Clock = std::chrono::steady_clock;

	void draw(EditorContext &r_context, glm::uvec2 p_size_px);
	void draw_compared(EditorContext &r_context, RenderRequest p_request);
	RenderResult draw_into(OwnedTexture &r_image, RenderRequest p_request, Renderer &r_renderer);
	void list_debug_views(EditorContext &r_context);

	RenderingDevice &device;
	Renderer &renderer;
	/// Holds the compared technique's caches; exists only during a comparison.
	std::unique_ptr<Renderer> compared_renderer;
	OwnedTexture image;
	OwnedTexture compared_image;
	std::string drawn_light; // name of the active light in the last image
	bool is_coarse = false;	 // the last image has reduced resolution
	uint32_t divisor = 2;	 // of width and height at reduced resolution
	uint32_t drawn_count = 0;
	uint32_t sharp_count = 0; // full-resolution images
	Clock::time_point last_change;
};

} // namespace gnomon
