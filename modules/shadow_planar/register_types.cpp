#include "modules/shadow_planar/register_types.h"

#include "modules/shadow_planar/shadow_planar.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_planar_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowTechniqueInfo info = { "planar", "Planar shadows, on declared planes only", "Blinn 1988",
		"#637939", [] { return std::make_unique<ShadowPlanar>(); } };
	info.needs_planar_receivers = true;
	ShadowRegistry::add(std::move(info));
}

void uninitialize_shadow_planar_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("planar");
}

} // namespace gnomon
