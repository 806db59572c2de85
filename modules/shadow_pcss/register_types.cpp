#include "modules/shadow_pcss/register_types.h"

#include "modules/shadow_pcss/shadow_pcss.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_pcss_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ShadowRegistry::add({ "pcss", "Percentage-closer soft shadows", "Fernando 2005", "#1f77b4",
				[] { return std::make_unique<ShadowPcss>(); } });
	}
}

void uninitialize_shadow_pcss_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ShadowRegistry::remove("pcss");
	}
}

} // namespace gnomon
