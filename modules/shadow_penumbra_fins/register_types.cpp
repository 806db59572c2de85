#include "modules/shadow_penumbra_fins/register_types.h"

#include "modules/shadow_penumbra_fins/shadow_penumbra_fins.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_penumbra_fins_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowTechniqueInfo fins = { "penumbra_fins", "Depth peeling and penumbra fins",
		"Sun, Lü, Liu, Wu 2010, 1006-8961(2010)09-1391-07", "#d62728", [] {
			return std::make_unique<ShadowPenumbraFins>(
					ShadowPenumbraFins::Halves::OUTER_AND_INNER);
		} };
	fins.derived_widths = PENUMBRA_FINS_WIDTHS;
	ShadowRegistry::add(std::move(fins));
	ShadowTechniqueInfo outer_fins = { "outer_fins", "Outer penumbra fins",
		"Lü, Meng, Xue et al. 2009, after Chan, Durand 2003", "#e377c2",
		[] { return std::make_unique<ShadowPenumbraFins>(ShadowPenumbraFins::Halves::OUTER); } };
	outer_fins.derived_widths = OUTER_FINS_WIDTHS;
	ShadowRegistry::add(std::move(outer_fins));
}

void uninitialize_shadow_penumbra_fins_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("outer_fins");
	ShadowRegistry::remove("penumbra_fins");
}

} // namespace gnomon
