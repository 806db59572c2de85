#include "modules/shadows/light_properties.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/shadows/mask_filter.h"
#include "modules/shadows/shadow_registry.h"

#include <set>

namespace gnomon {

namespace {

const char TECHNIQUE_PROPERTY[] = "shadow_technique";

/// Makes shadow_technique an enum of the registered techniques. Its first choice is the empty text,
/// which means the default. An example is listed only when it is chosen.
PropertyInfo make_choice(const PropertyInfo &p_info, const std::string &p_chosen_id) {
	PropertyInfo info = p_info;
	if (ShadowRegistry::get_all().empty()) {
		return info; // nothing to choose from
	}
	info.type = PropertyType::ENUM;
	const ShadowTechniqueInfo *chosen = ShadowRegistry::find_default();
	info.choice_tooltips = { text(
			"The default", chosen != nullptr ? ": " + chosen->name : std::string()) };
	for (const ShadowTechniqueInfo &technique : ShadowRegistry::get_all()) {
		if (technique.is_example && technique.id != p_chosen_id) {
			continue;
		}
		info.hint += "," + technique.id;
		info.choice_tooltips.push_back(technique.name + "\n" + technique.source);
	}
	return info;
}

std::vector<const PropertyList *> get_added_lists() {
	std::vector<const PropertyList *> lists;
	for (const ShadowTechniqueInfo &technique : ShadowRegistry::get_all()) {
		lists.push_back(&ShadowRegistry::get_light_properties(technique.id));
	}
	for (const MaskFilterInfo &filter : MaskFilterRegistry::get_all()) {
		lists.push_back(&MaskFilterRegistry::get_light_properties(filter.id));
	}
	return lists;
}

/// Logs one warning about all removed properties that have the same advice: once per index of the
/// light in its file (LightSnapshot::file_path, such as "lights[0]") and set of names.
void warn_of_removed(const LightSnapshot &p_light, const PropertyList &p_list) {
	static std::set<std::string> reported;
	std::map<std::string, std::string> names_of_advice;
	for (const RemovedProperty &removed : p_list.get_removed()) {
		if (p_light.properties.contains(removed.name)) {
			std::string &names = names_of_advice[removed.advice];
			names += (names.empty() ? "" : ", ") + removed.name;
		}
	}
	for (const auto &[advice, names] : names_of_advice) {
		if (reported.insert(text(p_light.file_path, "\n", names)).second) {
			log_warning("Light \"", p_light.name, "\" (", p_light.file_path, "): ", names,
					names.find(',') == std::string::npos ? " is" : " are", " not used any more. ",
					advice, " Remove it from the extras of the file's lights.");
		}
	}
}

} // namespace

void add_light_properties(const Node3D &p_node, PropertyList &r_list) {
	const Light3D *light = dynamic_cast<const Light3D *>(&p_node);
	if (light == nullptr) {
		return;
	}
	// Only name and technique are set: a full snapshot needs a transform that is not singular.
	LightSnapshot chosen;
	chosen.name = light->name;
	const auto stored = light->properties.find(TECHNIQUE_PROPERTY);
	if (stored != light->properties.end() && std::holds_alternative<std::string>(stored->second)) {
		chosen.technique_id = std::get<std::string>(stored->second);
	}
	if (const PropertyInfo *info = r_list.find(TECHNIQUE_PROPERTY)) {
		r_list.replace(make_choice(*info, chosen.technique_id));
	}
	if (const ShadowTechniqueInfo *technique = choose_technique(chosen, /*p_override=*/{}).info) {
		for (const PropertyInfo &info :
				ShadowRegistry::get_light_properties(technique->id).get_properties()) {
			r_list.add(info);
		}
	}
	for (const MaskFilterInfo &filter : MaskFilterRegistry::get_all()) {
		for (const PropertyInfo &info :
				MaskFilterRegistry::get_light_properties(filter.id).get_properties()) {
			r_list.add(info);
		}
	}
}

const RemovedProperty *find_removed_light_property(std::string_view p_name) {
	for (const PropertyList *list : get_added_lists()) {
		for (const RemovedProperty &removed : list->get_removed()) {
			if (removed.name == p_name) {
				return &removed;
			}
		}
	}
	return nullptr;
}

const PropertyInfo *find_added_light_property(std::string_view p_name) {
	for (const PropertyList *list : get_added_lists()) {
		if (const PropertyInfo *info = list->find(p_name)) {
			return info;
		}
	}
	return nullptr;
}

std::vector<std::string> list_added_light_properties() {
	std::vector<std::string> names;
	for (const PropertyList *list : get_added_lists()) {
		for (const PropertyInfo &info : list->get_properties()) {
			names.push_back(info.name);
		}
	}
	return names;
}

PropertyValues resolve_light_properties(const LightSnapshot &p_light, const PropertyList &p_list) {
	static std::set<std::string> reported;
	PropertyValues values;
	for (const PropertyInfo &info : p_list.get_properties()) {
		values[info.name] = info.default_value;
		const auto stored = p_light.properties.find(info.name);
		if (stored == p_light.properties.end()) {
			continue;
		}
		const std::string refusal = check_property(info, stored->second);
		if (refusal.empty()) {
			values[info.name] = convert_property(info, stored->second);
		} else if (const std::string line = text("Light \"", p_light.name, "\" (",
						   p_light.file_path, "): ", info.name, " ", refusal, ". The default, ",
						   format_property(info.default_value), ", is used.");
				   reported.insert(line).second) {
			log_error(line);
		}
	}
	warn_of_removed(p_light, p_list);
	return values;
}

void add_moved_setting(const std::string &p_id, const std::string &p_name, PropertyList &r_list) {
	r_list.add_removed({ text(p_id, "_", p_name),
			text("Settings of the technique are in [technique.", p_id,
					"] of project.cfg, or --set technique.", p_id, ".NAME=value.") });
}

void check_extension_properties(const std::string &p_id, const PropertyList &p_list) {
	for (const PropertyInfo &property : p_list.get_properties()) {
		GNOMON_ASSERT(property.name.rfind(p_id + "_", 0) == 0, "property ", property.name,
				" must begin with ", p_id, "_");
		GNOMON_ASSERT(!property.tooltip.empty(), "property ", property.name, " has no tooltip");
	}
}

} // namespace gnomon
