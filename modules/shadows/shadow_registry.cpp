#include "modules/shadows/shadow_registry.h"

#include "modules/core/log.h"

namespace gnomon {

const char *const TEST_SETTINGS_GROUP = "Tests";

namespace {

struct Settings {
	PropertyList list;
	PropertyValues values;
};

std::map<std::string, Settings, std::less<>> &get_all_settings() {
	static std::map<std::string, Settings, std::less<>> settings;
	return settings;
}

Settings &find_settings(std::string_view p_id) {
	return get_all_settings().find(ShadowRegistry::get(p_id).id)->second;
}

std::string list_settings(const PropertyList &p_list) {
	std::string names;
	for (const PropertyInfo &info : p_list.get_properties()) {
		if (info.group != TEST_SETTINGS_GROUP) {
			names += (names.empty() ? "" : ", ") + info.name;
		}
	}
	return names.empty() ? "(none)" : names;
}

} // namespace

void ShadowRegistry::add(ShadowTechniqueInfo p_info) {
	Settings settings;
	p_info.make()->get_settings(settings.list);
	for (const PropertyInfo &info : settings.list.get_properties()) {
		GNOMON_ASSERT(!info.tooltip.empty(), "setting ", info.name, " has no tooltip");
		settings.values[info.name] = info.default_value;
	}
	get_all_settings()[p_info.id] = std::move(settings);
	Registry::add(std::move(p_info));
}

void ShadowRegistry::remove(std::string_view p_id) {
	Registry::remove(p_id);
	get_all_settings().erase(std::string(p_id));
}

const PropertyList &ShadowRegistry::get_settings(std::string_view p_id) {
	return find_settings(p_id).list;
}

const PropertyValues &ShadowRegistry::get_setting_values(std::string_view p_id) {
	return find_settings(p_id).values;
}

void ShadowRegistry::set_setting(
		std::string_view p_id, std::string_view p_name, std::string_view p_text) {
	Settings &settings = find_settings(p_id);
	const PropertyInfo *info = settings.list.find(p_name);
	if (!info) {
		fail("Technique \"", p_id, "\" has no setting \"", p_name,
				"\". It has: ", list_settings(settings.list), ".");
	}
	settings.values[info->name] = parse_property(*info, p_text, text("Technique \"", p_id, "\""));
}

void apply_technique_settings(const Project &p_project) {
	for (auto &[id, settings] : get_all_settings()) {
		for (const PropertyInfo &info : settings.list.get_properties()) {
			settings.values[info.name] = info.default_value; // another project may have changed it
		}
	}
	for (const auto &[id, values] : p_project.technique_settings) {
		for (const auto &[name, value] : values) {
			try {
				ShadowRegistry::set_setting(id, name, value);
			} catch (const Error &error) {
				log_warning((p_project.folder / "project.cfg").string(), ": ", error.what());
			}
		}
	}
}

const ShadowTechniqueInfo &ShadowRegistry::get(std::string_view p_id) {
	if (const ShadowTechniqueInfo *info = find(p_id)) {
		return *info;
	}
	std::string ids;
	for (const ShadowTechniqueInfo &info : get_all()) {
		ids += (ids.empty() ? "" : ", ") + info.id;
	}
	fail("Shadow technique \"", p_id,
			"\" does not exist. Choose one of: ", ids.empty() ? "(none in this build)" : ids, ".");
}

const ShadowTechniqueInfo *ShadowRegistry::find_default() {
	const ShadowTechniqueInfo *best = nullptr;
	for (const ShadowTechniqueInfo &info : get_all()) {
		if (info.default_rank > (best ? best->default_rank : 0)) {
			best = &info;
		}
	}
	return best;
}

const ShadowTechniqueInfo *ShadowRegistry::find_fallback() {
	return find_if([](const ShadowTechniqueInfo &p_info) { return p_info.is_fallback; });
}

const ShadowTechniqueInfo *ShadowRegistry::find_reference() {
	return find_if([](const ShadowTechniqueInfo &p_info) { return p_info.is_reference; });
}

TechniqueChoice choose_technique(const LightSnapshot &p_light, const std::string &p_override) {
	if (!p_override.empty()) {
		return { &ShadowRegistry::get(p_override), {} };
	}
	if (p_light.technique_id.empty()) {
		const ShadowTechniqueInfo *info = ShadowRegistry::find_default();
		return { info,
			info ? ""
				 : text("Light \"", p_light.name,
						   "\": no technique that can be the default is enabled; it casts no "
						   "shadow. Enable a module (`gnomon modules` lists them), or set "
						   "shadow_technique.") };
	}
	if (const ShadowTechniqueInfo *info = ShadowRegistry::find(p_light.technique_id)) {
		return { info, {} };
	}
	const ShadowTechniqueInfo *info = ShadowRegistry::find_fallback();
	return { info,
		text("Light \"", p_light.name, "\": technique \"", p_light.technique_id,
				"\" is not enabled; ",
				info ? "\"" + info->id + "\" is used instead" : "it casts no shadow",
				". `gnomon techniques` lists those that are.") };
}

} // namespace gnomon
