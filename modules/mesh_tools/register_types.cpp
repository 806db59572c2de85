#include "modules/mesh_tools/register_types.h"

namespace gnomon {

// Nothing to register: pure functions that techniques call.
void initialize_mesh_tools_module(ModuleLevel) {}
void uninitialize_mesh_tools_module(ModuleLevel) {}

} // namespace gnomon
