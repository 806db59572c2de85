#pragma once

#include "modules/editor/editor_context.h"

#include <chrono>

namespace gnomon {

/// Draws the scene for the viewport, when something has changed: coarser while it moves on a device
/// that is a CPU, sharp once it rests.
class PictureMaker {
public:
	PictureMaker(RenderingDevice &p_device, Renderer &p_renderer) :
			device(p_device), renderer(p_renderer) {}

	/// Draws if need be. An Error is told in the status bar, and the last picture stays.
	void update(EditorContext &r_context);
	/// Empty before the first picture.
	TextureRID get_picture() const { return picture.get(); }
	/// Sharp ones that were drawn so far.
	uint32_t get_count() const { return sharp_count; }

private:
	using Clock = std::chrono::steady_clock;

	void draw(EditorContext &r_context, glm::uvec2 p_size_px);

	RenderingDevice &device;
	Renderer &renderer;
	OwnedTexture picture;
	bool is_coarse = false;
	uint32_t sharp_count = 0;
	Clock::time_point last_change;
};

} // namespace gnomon
