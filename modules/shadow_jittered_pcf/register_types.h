#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_shadow_jittered_pcf_module(ModuleLevel p_level);
void uninitialize_shadow_jittered_pcf_module(ModuleLevel p_level);

} // namespace gnomon
