#pragma once

#include "modules/renderer/lighting.h"

#include <span>
#include <string>
#include <vector>

// Intermediate images instead of the lit image: a technique's own, the mask, and its error.

namespace gnomon {

/// The reference mask of a light, one value per pixel, rows from the top.
struct ReferenceMask {
	glm::uvec2 size_px = glm::uvec2(0);
	std::vector<float> visibility; // 0..1
	std::vector<float> receiver;   // 1, or 0 where the light does not reach
};

/// Adds the view "error": the mask minus the reference in the colours of shared/heat_map_shared.h.
/// A reference of a size other than the frame's is an Error.
ShadowTechnique::DebugView add_error_view(
		const LitImage &p_image, const LightShadow &p_shadow, const ReferenceMask &p_reference);

/// Which view is requested, see RenderRequest.
struct DebugViewWish {
	const std::string &id;
	bool is_needed = true;
	bool has_reference = false;
};

/// Returns the requested view. Null: show the lit image, because none was requested, or one that
/// does not exist and is not needed. A needed one that does not exist is an Error that lists the
/// available views.
const ShadowTechnique::DebugView *choose_debug_view(
		std::span<const ShadowTechnique::DebugView> p_views, const DebugViewWish &p_wish);

/// Draws a debug view's texture instead of the lit image, as RGBA8_UNORM.
RGTexture add_debug_view_pass(const LitImage &p_image, const ShadowTechnique::DebugView &p_view);

} // namespace gnomon
