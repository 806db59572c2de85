#pragma once

#include "modules/shadows/shadow_registry.h"

namespace gnomon {

/// Changes a setting of a technique, and restores it when destroyed.
class SettingScope {
public:
	SettingScope(std::string p_id, std::string p_name, const std::string &p_text) :
			id(std::move(p_id)), name(std::move(p_name)),
			before(format_property(ShadowRegistry::get_setting_values(id).at(name))) {
		ShadowRegistry::set_setting(id, name, p_text);
	}
	~SettingScope() { ShadowRegistry::set_setting(id, name, before); }
	SettingScope(const SettingScope &) = delete;
	SettingScope &operator=(const SettingScope &) = delete;

private:
	std::string id;
	std::string name;
	std::string before;
};

} // namespace gnomon
