#include "modules/renderer/register_types.h"

namespace gnomon {

// Techniques, filters and their properties are registered by the modules that hold them.
void initialize_renderer_module(ModuleLevel) {}

void uninitialize_renderer_module(ModuleLevel) {}

} // namespace gnomon
