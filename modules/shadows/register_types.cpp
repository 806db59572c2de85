#include "modules/shadows/register_types.h"

#include "modules/scene/node_properties.h"
#include "modules/shadows/light_properties.h"

namespace gnomon {

// Techniques and filters register themselves in this module's registries.
void initialize_shadows_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::SERVERS) {
		add_node_property_source(&add_light_properties);
	}
}

void uninitialize_shadows_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::SERVERS) {
		remove_node_property_source(&add_light_properties);
	}
}

} // namespace gnomon
