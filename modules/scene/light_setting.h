#pragma once

#include <string>
#include <string_view>

namespace gnomon {

/// A light property that `--set` assigns.
struct LightSetting {
	std::string light_name; // empty: the light that the command draws or measures
	std::string property;
	std::string value; // as written; see parse_property
};

/// Reads "property=value" or "light.NAME.property=value"; NAME may contain dots. Other text is a
/// UsageError.
LightSetting parse_light_setting(std::string_view p_text);

} // namespace gnomon
