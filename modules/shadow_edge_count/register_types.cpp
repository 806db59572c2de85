#include "modules/shadow_edge_count/register_types.h"

namespace gnomon {

void initialize_shadow_edge_count_module(ModuleLevel /*p_level*/) {}

void uninitialize_shadow_edge_count_module(ModuleLevel /*p_level*/) {}

} // namespace gnomon
