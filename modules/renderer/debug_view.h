#pragma once

#include "modules/renderer/lighting.h"

#include <span>
#include <string>
#include <vector>

// Debug views, which are shown instead of the lit image: intermediate images of a technique, the
// mask, and the mask's error.

namespace gnomon {

/// The reference mask of a light: one value per pixel, rows from the top.
struct ReferenceMask {
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<float> visibility; // 0..1
	std::vector<float> receiver;   // 1, or 0 where the light does not reach
};

/// Adds the view "error": the mask minus the reference in the colours of shared/heat_map_shared.h.
/// A reference of a size other than the frame's is an Error.
ShadowTechnique::DebugView add_error_view(
		const LitImage &p_image, const LightShadow &p_shadow, const ReferenceMask &p_reference);

/// The debug view that a RenderRequest requests.
struct DebugViewRequest {
	const std::string &id;
	bool is_needed = true; // RenderRequest::needs_debug_view
	bool has_reference = false;
};

/// Returns the requested view. Returns null, to show the lit image, if none was requested, or if it
/// does not exist and is_needed is false. If it does not exist and is_needed is true, an Error
/// lists the available views.
const ShadowTechnique::DebugView *choose_debug_view(
		std::span<const ShadowTechnique::DebugView> p_views, const DebugViewRequest &p_request);

/// Draws a debug view's texture instead of the lit image, as RGBA8_UNORM.
RGTexture add_debug_view_pass(const LitImage &p_image, const ShadowTechnique::DebugView &p_view);

} // namespace gnomon
