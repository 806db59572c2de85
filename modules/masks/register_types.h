#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_masks_module(ModuleLevel p_level);
void uninitialize_masks_module(ModuleLevel p_level);

} // namespace gnomon
