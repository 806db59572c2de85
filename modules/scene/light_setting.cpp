#include "modules/scene/light_setting.h"

#include "modules/core/error.h"

namespace gnomon {

LightSetting parse_light_setting(std::string_view p_text) {
	constexpr std::string_view PREFIX = "light.";
	const size_t equals = p_text.find('=');
	if (equals == std::string_view::npos) {
		throw UsageError(text("--set is \"", p_text,
				"\", must be property=value, light.NAME.property=value or "
				"technique.ID.NAME=value."));
	}
	const std::string_view name = p_text.substr(0, equals);
	LightSetting setting{ "", std::string(name), std::string(p_text.substr(equals + 1)) };
	if (name.starts_with(PREFIX)) {
		const size_t dot = name.rfind('.');
		if (dot <= PREFIX.size()) {
			throw UsageError(text("--set is \"", p_text, "\", must be light.NAME.property=value."));
		}
		setting.light_name = name.substr(PREFIX.size(), dot - PREFIX.size());
		setting.property = name.substr(dot + 1);
	}
	return setting;
}

} // namespace gnomon
