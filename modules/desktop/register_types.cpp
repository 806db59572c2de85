#include "modules/desktop/register_types.h"

namespace gnomon {

// Nothing to register: whoever shows something makes its window.
void initialize_desktop_module(ModuleLevel) {}
void uninitialize_desktop_module(ModuleLevel) {}

} // namespace gnomon
