#include "modules/renderer/register_types.h"

namespace gnomon {

// Nothing to register: techniques and filters register themselves in this module's registries.
void initialize_renderer_module(ModuleLevel) {}
void uninitialize_renderer_module(ModuleLevel) {}

} // namespace gnomon
