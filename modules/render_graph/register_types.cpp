#include "modules/render_graph/register_types.h"

namespace gnomon {

// Nothing to register: the renderer makes its graphs itself.
void initialize_render_graph_module(ModuleLevel) {}
void uninitialize_render_graph_module(ModuleLevel) {}

} // namespace gnomon
