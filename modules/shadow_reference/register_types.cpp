#include "modules/shadow_reference/register_types.h"

#include "modules/shadow_reference/shadow_reference.h"
#include "modules/shadow_reference/shadow_reference_source.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_reference_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowTechniqueInfo info = { "reference", "Exact, by ray tracing on the CPU",
		"Area integral over the light's disc, Embree rays", "#17becf",
		[] { return std::make_unique<ShadowReference>(); } };
	info.is_reference = true;
	info.make_reference_source = [](ReferenceRequest p_request) {
		return std::make_unique<ShadowReferenceSource>(std::move(p_request));
	};
	ShadowRegistry::add(std::move(info));
}

void uninitialize_shadow_reference_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("reference");
}

} // namespace gnomon
