#pragma once

#include <cstdint>
#include <span>

namespace gnomon {

const uint32_t ALBEDO_SIZE = 32; // rows and columns of the table below

/// Returns the directional albedo E of Godot's GGX materials: the fraction of light that a surface
/// with a reflectance of 1 reflects with single scattering (Turquin 2019, section 3.1). A row for
/// each roughness from 0 to 1, in it a column for each cosine between the normal and the direction
/// to the viewer, from 0 to 1, both ends included. Measured in Godot's images, so it includes the
/// approximations of Godot's shader.
std::span<const float> get_directional_albedo();

} // namespace gnomon
