#pragma once

#include "modules/editor/background_reference.h"
#include "modules/editor/editor_context.h"
#include "modules/masks/mask_timing.h"

namespace gnomon {

/// Measures what the error panel shows for the active light (EditorContext::find_light): its mask
/// from the viewport's camera, the mask's cost (one measured frame per update), and its reference,
/// which is traced in the background. It works only while the panel or the viewport's
/// error view is visible.
class ErrorMeter {
public:
	ErrorMeter(RenderingDevice &p_device, Renderer &p_renderer) :
			device(p_device), renderer(p_renderer) {}

	/// Call it once a frame, after the viewport is drawn. p_image_count: number of full-resolution
	/// images drawn so far, from ViewportRenderer::get_sharp_count; a change starts a new
	/// measurement.
	void update(EditorContext &r_context, uint32_t p_image_count);

	/// Discards the measured cost, because the shaders have changed.
	void forget_cost();

	// Textures for the panel: RGBA8_UNORM, SAMPLED; empty if there is none yet.
	TextureRID get_mask_texture() const { return mask_texture.get(); }
	TextureRID get_reference_texture() const { return reference_texture.get(); }
	TextureRID get_error_texture() const { return error_texture.get(); }

private:
	void measure_mask(EditorContext &r_context);
	void measure_cost(EditorContext &r_context);
	bool has_cost() const;
	void request_reference(EditorContext &r_context, RenderResult p_result);
	void compare(ErrorState &r_state);
	/// Stops the measurement, discards the reference, and sets ErrorState::refusal.
	void refuse(ErrorState &r_state, std::string p_text);
	OwnedTexture upload_texture(const std::string &p_name, glm::uvec2 p_size_px,
			uint32_t p_channel_count, const std::vector<uint8_t> &p_pixels);

	RenderingDevice &device;
	Renderer &renderer;
	RenderRequest request;			  // that produced the current mask
	LightSnapshot light;			  // to which the current mask belongs
	uint32_t measured_image = 0;	  // p_image_count when the mask was measured; 0: measure again
	uint32_t traced_sample_count = 0; // target of the last trace, rays per pixel; 0: trace again
	std::string timed_key; // describes the state that `timings` measured, see describe_cost
	TimingSamples timings;
	double timed_ms = 0;		 // time that measuring `timings` took, in total
	bool is_error_stale = false; // the viewport's error view uses a reference that was discarded
	/// Creates the source to trace next. Tracing starts after the cost is measured, which it would
	/// disturb.
	std::function<std::unique_ptr<ReferenceSource>()> requested_reference;
	OwnedTexture mask_texture;
	OwnedTexture reference_texture;
	OwnedTexture error_texture;
	BackgroundReference background_reference; // declared last, so that its thread ends first
};

} // namespace gnomon
