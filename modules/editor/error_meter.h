#pragma once

#include "modules/editor/background_reference.h"
#include "modules/editor/editor_context.h"
#include "modules/masks/mask_timing.h"

namespace gnomon {

/// Updates the error panel: the mask of the light in question as the viewport sees it, its
/// reference (traced in the background), and the mask's cost, one measured frame at a time. Works
/// only while the panel or the viewport's error view is visible.
class ErrorMeter {
public:
	ErrorMeter(RenderingDevice &p_device, Renderer &p_renderer) :
			device(p_device), renderer(p_renderer) {}

	/// Call it once a frame, after the viewport is drawn. p_image_count: full-resolution images
	/// drawn so far, see ViewportRenderer.
	void update(EditorContext &r_context, uint32_t p_image_count);

	/// Discards the measured cost, because the shaders have changed.
	void forget_cost();

	/// RGBA8_UNORM, SAMPLED; empty if there is none yet.
	TextureRID get_mask_texture() const { return mask_texture.get(); }
	TextureRID get_reference_texture() const { return reference_texture.get(); }
	TextureRID get_error_texture() const { return error_texture.get(); }

private:
	void measure_mask(EditorContext &r_context);
	void measure_cost(EditorContext &r_context);
	bool has_cost() const;
	void request_reference(EditorContext &r_context, RenderResult p_result);
	void compare(ErrorState &r_state);
	void refuse(ErrorState &r_state, std::string p_text);
	OwnedTexture upload_texture(const std::string &p_name, glm::uvec2 p_size_px,
			uint32_t p_channel_count, const std::vector<uint8_t> &p_pixels);

	RenderingDevice &device;
	Renderer &renderer;
	RenderRequest request; // request of the mask that is shown
	LightSnapshot light;
	uint32_t measured_image = 0; // ViewportRenderer's count when the mask was measured
	uint32_t traced_sample_count = 0;
	std::string timed_key; // key of what `timings` measured
	TimingSamples timings;
	double timed_ms = 0;		 // by those frames
	bool is_error_stale = false; // the error view may be outdated
	/// Traced after the cost is measured: both at once would slow each other down.
	std::function<std::unique_ptr<ReferenceSource>()> requested_reference;
	OwnedTexture mask_texture;
	OwnedTexture reference_texture;
	OwnedTexture error_texture;
	BackgroundReference background_reference; // last, so that its thread ends first
};

} // namespace gnomon
