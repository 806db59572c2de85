#include "modules/shader_reload/register_types.h"

namespace gnomon {

// Nothing to register: whoever edits makes its watcher.
void initialize_shader_reload_module(ModuleLevel) {}
void uninitialize_shader_reload_module(ModuleLevel) {}

} // namespace gnomon
