#include "modules/shadow_volume/register_types.h"

#include "modules/shadow_volume/shadow_volume.h"
#include "modules/shadows/shadow_registry.h"

namespace gnomon {

void initialize_shadow_volume_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::add({ "shadow_volume", "Shadow volumes: hard, exact in every pixel",
			"GPU Gems 3, chapter 11", "#393b79",
			[] { return std::make_unique<ShadowVolume>(ShadowVolume::Silhouettes::GPU); } });
	ShadowRegistry::add({ "shadow_volume_cpu", "Shadow volumes made on the CPU",
			"DOOM 3, id Software 2004", "#9c9ede",
			[] { return std::make_unique<ShadowVolume>(ShadowVolume::Silhouettes::CPU); } });
}

void uninitialize_shadow_volume_module(ModuleLevel p_level) {
	if (p_level != ModuleLevel::FEATURES) {
		return;
	}
	ShadowRegistry::remove("shadow_volume_cpu");
	ShadowRegistry::remove("shadow_volume");
}

} // namespace gnomon
