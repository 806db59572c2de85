#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_core_module(ModuleLevel p_level);
void uninitialize_core_module(ModuleLevel p_level);

} // namespace gnomon
