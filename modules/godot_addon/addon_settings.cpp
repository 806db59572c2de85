#include "modules/godot_addon/addon_settings.h"

#include "modules/core/log.h"
#include "modules/godot_addon/shadow_properties.h"

#include "godot_addon/godot_addon_shared.h"

#include <godot_api.gen.h>

#include <algorithm>
#include <set>

namespace gnomon {

namespace {

godot::Variant read_setting(const char *p_name, const godot::Variant &p_default) {
	const godot::ProjectSettings settings(godot::find_singleton("ProjectSettings"));
	return settings.has_setting(p_name) ? settings.get_setting_with_override(p_name) : p_default;
}

const double LEAST_RESOLUTION_SCALE = 0.25;

std::string read_default_technique() {
	static std::set<std::string> refused;
	const PropertyInfo &info = get_default_technique_setting();
	const std::string wanted =
			read_setting(info.name.c_str(), std::get<std::string>(info.default_value)).to_utf8();
	const std::string refusal = check_property(info, wanted);
	if (refusal.empty()) {
		return wanted;
	}
	if (refused.insert(wanted).second) {
		log_warning("Project setting ", info.name, " ", refusal, ". ",
				format_property(info.default_value), " is used.");
	}
	return std::get<std::string>(info.default_value);
}

} // namespace

AddonSettings read_addon_settings() {
	AddonSettings settings;
	settings.is_enabled = read_setting("rendering/gnomon/enabled", settings.is_enabled).to_bool();
	const int64_t most =
			read_setting("rendering/gnomon/most_lights", int64_t(settings.most_lights)).to_int();
	settings.most_lights = size_t(std::clamp<int64_t>(most, 1, RECEIVER_ROW_COUNT - 1));
	settings.default_technique = read_default_technique();
	settings.mask_resolution_scale = static_cast<float>(
			std::clamp(read_setting("rendering/gnomon/mask_resolution_scale", 1.0).to_float(),
					LEAST_RESOLUTION_SCALE, 1.0));
	return settings;
}

bool uses_physical_light_units() {
	return read_setting("rendering/lights_and_shadows/use_physical_light_units", false).to_bool();
}

} // namespace gnomon
