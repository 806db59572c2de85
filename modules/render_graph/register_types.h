#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_render_graph_module(ModuleLevel p_level);
void uninitialize_render_graph_module(ModuleLevel p_level);

} // namespace gnomon
