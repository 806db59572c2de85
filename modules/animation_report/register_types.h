#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_animation_report_module(ModuleLevel p_level);
void uninitialize_animation_report_module(ModuleLevel p_level);

} // namespace gnomon
