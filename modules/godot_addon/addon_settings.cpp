#include "modules/godot_addon/addon_settings.h"

#include "modules/core/log.h"
#include "modules/core/text.h"
#include "modules/godot_addon/shadow_properties.h"

#include "godot_addon/godot_addon_shared.h"

#include <godot_api.gen.h>

#include <set>

namespace gnomon {

namespace {

godot::Variant read_setting(const char *p_name, const godot::Variant &p_default) {
	const godot::ProjectSettings settings(godot::find_singleton("ProjectSettings"));
	return settings.has_setting(p_name) ? settings.get_setting_with_override(p_name) : p_default;
}

// These serve only to check values. Godot gets the settings from addons/gnomon/plugin.gd, which
// must have the same names, defaults and ranges.

PropertyInfo make_most_lights_setting() {
	PropertyInfo info;
	info.name = "rendering/gnomon/most_lights";
	info.type = PropertyType::INT;
	info.default_value = int64_t(16);
	info.hint = text("1,", RECEIVER_ROW_COUNT - 1, ",1");
	return info;
}

PropertyInfo make_keep_setting() {
	PropertyInfo info;
	info.name = "rendering/gnomon/keep_godot_shadows";
	info.type = PropertyType::ENUM;
	info.default_value = std::string("auto");
	info.hint = "auto,always,never";
	return info;
}

PropertyInfo make_resolution_setting() {
	PropertyInfo info;
	info.name = "rendering/gnomon/mask_resolution_scale";
	info.default_value = 1.0;
	info.hint = "0.25,1,0.01";
	return info;
}

/// Returns the project setting p_info, or its default if it is missing or invalid. An invalid value
/// is logged once. p_convert: reads a Value from the setting.
template <typename Value>
Value read_checked(const PropertyInfo &p_info, Value (*p_convert)(const godot::Variant &)) {
	static std::set<std::string> logged_refusals;
	const Value default_value = std::get<Value>(p_info.default_value);
	const Value requested = p_convert(read_setting(p_info.name.c_str(), default_value));
	const std::string refusal = check_property(p_info, requested);
	if (refusal.empty()) {
		return requested;
	}
	if (logged_refusals.insert(p_info.name + refusal).second) {
		log_warning("Project setting ", p_info.name, " ", refusal, ". ",
				format_property(p_info.default_value), " is used.");
	}
	return default_value;
}

} // namespace

AddonSettings read_addon_settings() {
	static const PropertyInfo most_lights = make_most_lights_setting();
	static const PropertyInfo resolution = make_resolution_setting();
	static const PropertyInfo keep = make_keep_setting();
	AddonSettings settings;
	settings.is_enabled = read_setting("rendering/gnomon/enabled", settings.is_enabled).to_bool();
	settings.is_compilation_gradual =
			read_setting("rendering/gnomon/gradual_compilation", settings.is_compilation_gradual)
					.to_bool();
	settings.allows_other_drivers =
			read_setting("rendering/gnomon/other_drivers", settings.allows_other_drivers).to_bool();
	settings.most_lights = size_t(read_checked<int64_t>(
			most_lights, [](const godot::Variant &p_value) { return p_value.to_int(); }));
	settings.default_technique = read_checked<std::string>(get_default_technique_setting(),
			[](const godot::Variant &p_value) { return p_value.to_utf8(); });
	settings.mask_resolution_scale = static_cast<float>(read_checked<double>(
			resolution, [](const godot::Variant &p_value) { return p_value.to_float(); }));
	const std::string shadows = read_checked<std::string>(
			keep, [](const godot::Variant &p_value) { return p_value.to_utf8(); });
	settings.keep_godot_shadows = shadows == "always" ? KeepGodotShadows::ALWAYS
			: shadows == "never"					  ? KeepGodotShadows::NEVER
													  : KeepGodotShadows::AUTO;
	return settings;
}

bool uses_physical_light_units() {
	return read_setting("rendering/lights_and_shadows/use_physical_light_units", false).to_bool();
}

} // namespace gnomon
