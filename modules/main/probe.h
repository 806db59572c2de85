#pragma once

#include "modules/renderer/renderer.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace gnomon {

inline constexpr const char *WORST_PIXEL = "worst";

/// Parses "X,Y", a pixel of an image of that size, from the top left. Nothing for WORST_PIXEL.
/// Throws a UsageError if the text has another form or the pixel is outside the image.
std::optional<glm::uvec2> parse_pixel(const std::string &p_text, glm::uvec2 p_size_px);

/// Describes one pixel of the mask of the request's mask_light, and how its value came about: the
/// surface, the mask's value, that of the reference with its standard error (where a reference
/// technique is enabled), and what the technique itself knows, see ShadowTechnique::explain.
/// p_pixel: nothing for the receiver with the largest error. Draws the reference's mask, then the
/// mask. Throws an Error if they cannot be drawn, or if the worst pixel is asked for without a
/// reference.
ProbeEntry explain_pixel(
		Renderer &r_renderer, RenderRequest p_request, std::optional<glm::uvec2> p_pixel);

/// Returns an object, or a list of the entries below one with is_list.
nlohmann::ordered_json probe_to_json(const ProbeEntry &p_entry);
/// Returns lines "name: value", indented by four spaces below each entry.
std::string probe_to_text(const ProbeEntry &p_entry);

} // namespace gnomon
