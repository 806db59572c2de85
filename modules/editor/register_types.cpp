#include "modules/editor/register_types.h"

namespace gnomon {

// Nothing to register: run_editor makes its panels when it is called.
void initialize_editor_module(ModuleLevel) {}
void uninitialize_editor_module(ModuleLevel) {}

} // namespace gnomon
