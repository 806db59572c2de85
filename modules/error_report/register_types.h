#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_error_report_module(ModuleLevel p_level);
void uninitialize_error_report_module(ModuleLevel p_level);

} // namespace gnomon
