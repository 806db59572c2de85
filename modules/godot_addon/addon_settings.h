#pragma once

#include <cstddef>

namespace gnomon {

/// What the project's settings below rendering/gnomon say; defaults where it has none. In the
/// editor they are read again each frame, in the game once.
struct AddonSettings {
	bool is_enabled = true;	 // false: all lights are Godot's
	size_t most_lights = 16; // with masks, of each world
};
AddonSettings read_addon_settings();

/// Whether Godot's lights have physical units, which its project decides.
bool uses_physical_light_units();

} // namespace gnomon
