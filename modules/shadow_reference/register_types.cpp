#include "modules/shadow_reference/register_types.h"

namespace gnomon {

// Nothing to register yet: only the ray tracer on the CPU is here.
void initialize_shadow_reference_module(ModuleLevel) {}
void uninitialize_shadow_reference_module(ModuleLevel) {}

} // namespace gnomon
