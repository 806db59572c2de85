#include "modules/renderer/debug_view.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/render_graph/compute_pass.h"
#include "modules/shadows/mask.h"

#include "renderer/renderer_shared.h"

namespace gnomon {

namespace {

const char ERROR_VIEW[] = "error";
const float NO_RECEIVER = -1.0f; // reference value of pixels without receiver, see error_view.comp

} // namespace

ShadowTechnique::DebugView add_error_view(
		const LitImage &p_image, const LightShadow &p_shadow, const ReferenceMask &p_reference) {
	const glm::uvec2 size_px = p_image.size_px;
	if (p_reference.size_px != size_px) {
		fail("The reference has ", p_reference.size_px.x, " x ", p_reference.size_px.y,
				" pixels, the frame ", size_px.x, " x ", size_px.y,
				". Make both with the same --size.");
	}
	std::vector<float> reference = p_reference.visibility;
	for (size_t pixel = 0; pixel < reference.size(); ++pixel) {
		reference[pixel] = p_reference.receiver[pixel] >= 0.5f ? reference[pixel] : NO_RECEIVER;
	}
	const RGBuffer buffer = p_image.graph.upload(
			"reference mask", BufferUsage::STORAGE, bytes_of(std::span<const float>(reference)));
	const RGTexture error = p_image.graph.create_texture({ "mask error", Format::RGBA8_UNORM,
			size_px, 1, TextureUsage::STORAGE | TextureUsage::SAMPLED });
	add_compute_pass(p_image.graph, "mask error",
			p_image.device.get_compute_pipeline({ "mask error", "renderer/error_view.comp",
					make_mask_constants(p_image.graph, p_shadow.mask) }),
			{
					PassBinding::read(RENDERER_BINDING_REFERENCE, buffer),
					PassBinding::read(RENDERER_BINDING_RECEIVERS, p_shadow.receivers),
					PassBinding::read(RENDERER_BINDING_MASK, p_shadow.mask),
					PassBinding::write(RENDERER_BINDING_OUTPUT, error),
			},
			glm::uvec3(size_px, 1u));
	ShadowTechnique::DebugView view = { ERROR_VIEW, error };
	view.is_color = true;
	return view;
}

const ShadowTechnique::DebugView *choose_debug_view(
		std::span<const ShadowTechnique::DebugView> p_views, const DebugViewRequest &p_request) {
	if (p_request.id.empty()) {
		return nullptr;
	}
	std::string ids;
	for (const ShadowTechnique::DebugView &view : p_views) {
		if (view.id == p_request.id) {
			return &view;
		}
		ids += (ids.empty() ? "\"" : ", \"") + view.id + "\"";
	}
	if (!p_request.is_needed) {
		return nullptr;
	}
	if (ids.empty()) {
		fail("Debug view \"", p_request.id,
				"\": no light casts a shadow. Set shadow_enabled of a light, or enable a "
				"technique; "
				"`gnomon run --plan` lists why.");
	}
	if (p_request.id == ERROR_VIEW && !p_request.has_reference) {
		fail("Debug view \"error\": no reference is loaded. Make one with `gnomon visibility SCENE "
			 "--technique reference --out reference.exr`, and pass it with --reference "
			 "reference.exr.");
	}
	fail("Debug view \"", p_request.id,
			"\" does not exist for this light's technique, must be one of ", ids, ".");
}

RGTexture add_debug_view_pass(const LitImage &p_image, const ShadowTechnique::DebugView &p_view) {
	const RGTexture output = create_output_image(p_image.graph, p_image.size_px);
	const shader::DebugViewPush push = { p_view.shown_range, p_view.class_count,
		p_view.is_color ? 1u : 0u };
	PassBinding shown = PassBinding::read(RENDERER_BINDING_MASK, p_view.texture);
	shown.layer = p_view.layer;
	add_compute_pass(p_image.graph, "debug view " + p_view.id,
			p_image.device.get_compute_pipeline({ "debug view", "renderer/debug_view.comp", {} }),
			{
					PassBinding::constants(RENDERER_BINDING_FRAME, p_image.frame),
					shown,
					PassBinding::write(RENDERER_BINDING_OUTPUT, output),
			},
			p_image.size_px, push);
	return output;
}

} // namespace gnomon
