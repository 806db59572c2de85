#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_shader_reload_module(ModuleLevel p_level);
void uninitialize_shader_reload_module(ModuleLevel p_level);

} // namespace gnomon
