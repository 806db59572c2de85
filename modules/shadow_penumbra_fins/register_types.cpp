#include "modules/shadow_penumbra_fins/register_types.h"

#include "modules/shadow_penumbra_fins/shadow_penumbra_fins.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_penumbra_fins_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::add({ "penumbra_fins", "Depth peeling and penumbra fins",
			"Sun, Lü, Liu, Wu 2010, 1006-8961(2010)09-1391-07", "#d62728", [] {
				return std::make_unique<ShadowPenumbraFins>(
						ShadowPenumbraFins::Halves::OUTER_AND_INNER);
			} });
	ShadowRegistry::add({ "outer_fins", "Outer penumbra fins",
			"Lü, Meng, Xue et al. 2009, after Chan, Durand 2003", "#e377c2", [] {
				return std::make_unique<ShadowPenumbraFins>(ShadowPenumbraFins::Halves::OUTER);
			} });
}

void uninitialize_shadow_penumbra_fins_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("outer_fins");
	ShadowRegistry::remove("penumbra_fins");
}

} // namespace gnomon
