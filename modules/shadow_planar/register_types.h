#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_shadow_planar_module(ModuleLevel p_level);
void uninitialize_shadow_planar_module(ModuleLevel p_level);

} // namespace gnomon
