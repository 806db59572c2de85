#include "modules/renderer/light_properties.h"

#include "modules/core/text.h"
#include "modules/renderer/light_shadows.h"
#include "modules/renderer/shadow_registry.h"
#include "modules/scene/scene_snapshot.h"

namespace gnomon {

namespace {

const char TECHNIQUE[] = "shadow_technique";

/// The techniques to choose from, the default first.
PropertyInfo make_choice(const PropertyInfo &p_info) {
	PropertyInfo info = p_info;
	if (ShadowRegistry::get_techniques().empty()) {
		return info; // nothing to choose from
	}
	info.type = PropertyType::ENUM;
	const ShadowTechniqueInfo *chosen = ShadowRegistry::find_default();
	info.choice_tooltips = { text(
			"The default", chosen != nullptr ? ": " + chosen->name : std::string()) };
	for (const ShadowTechniqueInfo &technique : ShadowRegistry::get_techniques()) {
		info.hint += "," + technique.id;
		info.choice_tooltips.push_back(technique.name + "\n" + technique.source);
	}
	return info;
}

} // namespace

void add_light_properties(const Node3D &p_node, PropertyList &r_list) {
	const Light3D *light = dynamic_cast<const Light3D *>(&p_node);
	if (light == nullptr) {
		return;
	}
	if (const PropertyInfo *info = r_list.find(TECHNIQUE)) {
		r_list.replace(make_choice(*info));
	}
	LightSnapshot chosen; // of which the id alone is asked for: the light's place may be singular
	chosen.name = light->name;
	const auto stored = light->properties.find(TECHNIQUE);
	if (stored != light->properties.end() && std::holds_alternative<std::string>(stored->second)) {
		chosen.technique_id = std::get<std::string>(stored->second);
	}
	if (const ShadowTechniqueInfo *technique = choose_technique(chosen, {}).info) {
		for (const PropertyInfo &info :
				ShadowRegistry::get_light_properties(technique->id).get_properties()) {
			r_list.add(info);
		}
	}
}

} // namespace gnomon
