#include "modules/main/register_types.h"

namespace gnomon {

// Nothing to register: main.cpp is where the program begins.
void initialize_main_module(ModuleLevel) {}
void uninitialize_main_module(ModuleLevel) {}

} // namespace gnomon
