#pragma once

#include "modules/editor/background_reference.h"
#include "modules/editor/editor_context.h"
#include "modules/masks/mask_timing.h"

namespace gnomon {

/// Keeps the error panel current: the mask of the light in question as the viewport sees it, its
/// reference in the background, and what the mask costs, a frame at a time. Works only while
/// somebody looks.
class ErrorMeter {
public:
	ErrorMeter(RenderingDevice &p_device, Renderer &p_renderer) :
			device(p_device), renderer(p_renderer) {}

	/// Once a frame, after the viewport is drawn. p_image_count: sharp ones drawn so far, see
	/// ViewportRenderer.
	void update(EditorContext &r_context, uint32_t p_image_count);

	/// Measures it again: the shaders are others.
	void forget_cost();

	/// RGBA8_UNORM, SAMPLED; empty where there is none yet.
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
	RenderRequest request; // of the mask that is shown
	LightSnapshot light;
	uint32_t measured_image = 0; // ViewportRenderer's count then
	uint32_t traced_sample_count = 0;
	std::string timed_key; // what `timings` are of
	TimingSamples timings;
	double timed_ms = 0;		 // by those frames
	bool is_error_stale = false; // the viewport may show an error that is none
	/// Traced once the cost is known: both at once would slow each other.
	std::function<std::unique_ptr<ReferenceSource>()> requested_reference;
	OwnedTexture mask_texture;
	OwnedTexture reference_texture;
	OwnedTexture error_texture;
	BackgroundReference background_reference; // last: its thread ends first
};

} // namespace gnomon
