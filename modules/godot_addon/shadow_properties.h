#pragma once

#include "modules/core/property.h"

#include <string>
#include <vector>

namespace gnomon {

/// A property of GnomonShadow3D.
struct ShadowProperty {
	PropertyInfo info;
	/// The only technique that has the property; empty: all have it.
	std::string technique;
};

inline constexpr char TECHNIQUE_PROPERTY[] = "technique";
inline constexpr char BACK_FACES_PROPERTY[] = "cast_back_faces";
inline constexpr char SHOW_MASK_PROPERTY[] = "show_mask";

/// Value of the property "technique": the technique of the project setting below.
inline constexpr char DEFAULT_TECHNIQUE[] = "default";

/// Returns the project setting of the default technique.
const PropertyInfo &get_default_technique_setting();

/// Returns all properties in display order, including those of all techniques that are offered in
/// Godot. The techniques must be registered before the first call.
const std::vector<ShadowProperty> &get_shadow_properties();

/// Returns the class documentation as XML. Godot's editor also takes tooltips from it.
std::string write_class_documentation();

} // namespace gnomon
