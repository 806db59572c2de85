#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_receiver_scatter_module(ModuleLevel p_level);
void uninitialize_receiver_scatter_module(ModuleLevel p_level);

} // namespace gnomon
