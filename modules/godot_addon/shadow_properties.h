#pragma once

#include "modules/core/property.h"

#include <string>
#include <vector>

namespace gnomon {

/// A property of GnomonShadow3D.
struct ShadowProperty {
	PropertyInfo info;
	/// Of this technique alone; empty: of every one.
	std::string technique;
};

inline constexpr char TECHNIQUE_PROPERTY[] = "technique";
inline constexpr char SHOW_MASK_PROPERTY[] = "show_mask";

/// The technique that the project names, its own or edge_count.
inline constexpr char DEFAULT_TECHNIQUE[] = "default";

/// The project setting with that technique.
const PropertyInfo &get_default_technique_setting();

/// All properties, those of all techniques that Godot's users are offered included; in the order
/// in which they are shown. The techniques must be registered.
const std::vector<ShadowProperty> &get_shadow_properties();

/// Class documentation for Godot's editor, from which it takes tooltips: XML.
std::string write_class_documentation();

} // namespace gnomon
