#include "modules/masks/register_types.h"

#include "modules/masks/command_compare.h"

namespace gnomon {

void initialize_masks_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		CommandRegistry::add({ "compare", &add_compare_command });
	}
}

void uninitialize_masks_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		CommandRegistry::remove("compare");
	}
}

} // namespace gnomon
