#include "modules/shadow_template/register_types.h"

#include "modules/renderer/shadow_registry.h"
#include "modules/shadow_template/shadow_template.h"

namespace gnomon {

void initialize_shadow_template_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::add({ "template", "Template: one hard comparison", "doc/add_a_technique.md",
			[] { return std::make_unique<ShadowTemplate>(); } });
}

void uninitialize_shadow_template_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("template");
}

} // namespace gnomon
