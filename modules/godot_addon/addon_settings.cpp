#include "modules/godot_addon/addon_settings.h"

#include "godot_addon/godot_addon_shared.h"

#include <godot_api.gen.h>

#include <algorithm>

namespace gnomon {

namespace {

godot::Variant read_setting(const char *p_name, const godot::Variant &p_default) {
	const godot::ProjectSettings settings(godot::find_singleton("ProjectSettings"));
	return settings.has_setting(p_name) ? settings.get_setting_with_override(p_name) : p_default;
}

} // namespace

AddonSettings read_addon_settings() {
	AddonSettings settings;
	settings.is_enabled = read_setting("rendering/gnomon/enabled", settings.is_enabled).to_bool();
	const int64_t most =
			read_setting("rendering/gnomon/most_lights", int64_t(settings.most_lights)).to_int();
	settings.most_lights = size_t(std::clamp<int64_t>(most, 1, RECEIVER_ROW_COUNT - 1));
	return settings;
}

bool uses_physical_light_units() {
	return read_setting("rendering/lights_and_shadows/use_physical_light_units", false).to_bool();
}

} // namespace gnomon
