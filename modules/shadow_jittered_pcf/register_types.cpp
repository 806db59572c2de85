#include "modules/shadow_jittered_pcf/register_types.h"

#include "modules/shadow_jittered_pcf/shadow_jittered_pcf.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_jittered_pcf_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ShadowRegistry::add({ "jittered_pcf", "Jittered percentage-closer filter",
				"OpenGL 4 Shading Language Cookbook, chapter 7", "#2ca02c",
				[] { return std::make_unique<ShadowJitteredPcf>(); } });
	}
}

void uninitialize_shadow_jittered_pcf_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ShadowRegistry::remove("jittered_pcf");
	}
}

} // namespace gnomon
