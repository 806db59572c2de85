#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_mesh_tools_module(ModuleLevel p_level);
void uninitialize_mesh_tools_module(ModuleLevel p_level);

} // namespace gnomon
