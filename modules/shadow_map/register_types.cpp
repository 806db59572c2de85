#include "modules/shadow_map/register_types.h"

#include "modules/shadow_map/shadow_map.h"
#include "modules/shadow_map/views.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_map_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowTechniqueInfo map = { "shadow_map", "Shadow map, hard or filtered",
		"Williams 1978; Reeves, Salesin, Cook 1987", "#7f7f7f",
		[] { return std::make_unique<ShadowMap>(); } };
	map.default_rank = 1;
	map.is_fallback = true;
	ShadowRegistry::add(std::move(map));
	ShadowRegistry::add({ "views", "Mean of many hard shadow maps", "Brute force", "#8c564b",
			[] { return std::make_unique<Views>(); } });
}

void uninitialize_shadow_map_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("views");
	ShadowRegistry::remove("shadow_map");
}

} // namespace gnomon
