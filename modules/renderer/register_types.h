#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_renderer_module(ModuleLevel p_level);
void uninitialize_renderer_module(ModuleLevel p_level);

} // namespace gnomon
