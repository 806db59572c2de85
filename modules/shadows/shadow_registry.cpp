#include "modules/shadows/shadow_registry.h"

namespace gnomon {

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
						   "\": no technique is enabled; it casts no shadow. ",
						   "Enable a module; `gnomon modules` lists them.") };
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
