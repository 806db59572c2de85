#pragma once

#include <cstddef>
#include <string>

namespace gnomon {

/// What the project's settings below rendering/gnomon state; defaults where it has none, and,
/// with one warning, where a value is refused. A game may change them while it runs.
struct AddonSettings {
	bool is_enabled = true;			 // false: all lights are Godot's
	size_t most_lights = 16;		 // with masks, of each world
	std::string default_technique;	 // of nodes whose technique is DEFAULT_TECHNIQUE
	float mask_resolution_scale = 1; // pixels of a mask to those of the view, along each side
};
AddonSettings read_addon_settings();

/// Whether Godot's lights have physical units, which its project decides.
bool uses_physical_light_units();

} // namespace gnomon
