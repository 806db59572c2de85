#include "modules/core/register_types.h"

namespace gnomon {

// Nothing to register: core holds only what the others are made of.
void initialize_core_module(ModuleLevel) {}
void uninitialize_core_module(ModuleLevel) {}

} // namespace gnomon
