#pragma once

#include <cstdint>
#include <span>

namespace gnomon {

const uint32_t ALBEDO_SIZE = 32;

/// The share of light that a surface of GGX microfacets with a reflectance of 1 scatters once, as
/// Godot's materials have it (Turquin 2019, section 3.1: E). Rows of roughness from 0 to 1, the
/// cosine to the viewer from 0 to 1 along each.
std::span<const float> get_directional_albedo();

} // namespace gnomon
