#include "modules/shadow_edge_count/register_types.h"

#include "modules/shadow_edge_count/shadow_edge_count.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_edge_count_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowTechniqueInfo info = { "edge_count", "Silhouette edges counted per receiver",
		"Own; after Sun, Lü, Liu, Wu 2010", "#ff7f0e",
		[] { return std::make_unique<ShadowEdgeCount>(); } };
	info.default_rank = 2; // above shadow_map
	ShadowRegistry::add(std::move(info));
}

void uninitialize_shadow_edge_count_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		ShadowRegistry::remove("edge_count");
	}
}

} // namespace gnomon
