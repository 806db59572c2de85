#pragma once

#include "modules/core/log_failures.h"
#include "modules/rendering_device_godot/godot_interface.h"
#include "modules/rendering_device_godot/godot_values.h"

#include <optional>
#include <span>
#include <vector>

// Registration of classes with GDExtension.

namespace gnomon {

struct MethodArgument {
	const char *name;
	godot::BuiltInType type;
};
/// A method of a class, as Godot's scripts call it.
struct MethodEntry {
	const char *name;
	/// p_instance: the native data of the object. Exceptions are logged.
	godot::Variant (*method)(void *p_instance, std::span<const godot::Variant> p_arguments);
	std::vector<MethodArgument> arguments;
	std::optional<godot::BuiltInType> result; // empty: it returns nothing
};

/// Owns the strings to which a GDExtensionPropertyInfo points.
struct PropertyTexts {
	godot::StringName name;
	godot::StringName class_name;
	godot::String hint;

	explicit PropertyTexts(const char *p_name, const std::string &p_hint = {});
	/// p_hint: a PropertyHint of Godot; 0: none.
	GDExtensionPropertyInfo make_info(godot::BuiltInType p_type, uint32_t p_hint = 0) const;
};

/// The entry must exist until the class is unregistered.
void register_method(const godot::StringName &p_class, const MethodEntry &p_entry);

} // namespace gnomon
