#include "modules/shadow_template/register_types.h"

#include "modules/shadow_template/shadow_template.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_template_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowTechniqueInfo info = { "template", "Template: one hard comparison",
		"doc/add_a_technique.md", "#bcbd22", [] { return std::make_unique<ShadowTemplate>(); } };
	info.is_example = true; // delete in a copy: the error report then measures it
	ShadowRegistry::add(std::move(info));
}

void uninitialize_shadow_template_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("template");
}

} // namespace gnomon
