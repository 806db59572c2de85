#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_desktop_module(ModuleLevel p_level);
void uninitialize_desktop_module(ModuleLevel p_level);

} // namespace gnomon
