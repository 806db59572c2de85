#pragma once

#include <cstddef>
#include <string>

namespace gnomon {

/// Whether lights with masks also keep Godot's shadow for objects that are no nodes.
enum class KeepGodotShadows {
	AUTO,	// where a viewport draws more objects than the nodes of its world
	ALWAYS, // for all objects
	NEVER,
};

/// The project settings under rendering/gnomon. A setting that is missing has its default. One with
/// an invalid value has its default too, with one warning. A game may change them while it runs.
struct AddonSettings {
	bool is_enabled = true;			 // false: all lights have Godot's shadows
	size_t most_lights = 16;		 // max. lights with masks in each world
	std::string default_technique;	 // for nodes whose technique is "default"
	float mask_resolution_scale = 1; // mask width / view width, 0.25 to 1
	KeepGodotShadows keep_godot_shadows = KeepGodotShadows::AUTO;
	/// In games at most one shader is compiled in each frame. What needs others keeps Godot's
	/// shadow.
	bool is_compilation_gradual = true;
	/// Whether masks are also made where Godot draws with another API than Vulkan. Read when the
	/// game starts.
	bool allows_other_drivers = false;
};
AddonSettings read_addon_settings();

/// Whether the project setting use_physical_light_units is on.
bool uses_physical_light_units();

} // namespace gnomon
