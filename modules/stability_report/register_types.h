#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_stability_report_module(ModuleLevel p_level);
void uninitialize_stability_report_module(ModuleLevel p_level);

} // namespace gnomon
