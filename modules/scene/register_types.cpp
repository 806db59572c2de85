#include "modules/scene/register_types.h"

namespace gnomon {

// Nothing to register: nodes are made by whoever reads a file, and found by their class.
void initialize_scene_module(ModuleLevel) {}
void uninitialize_scene_module(ModuleLevel) {}

} // namespace gnomon
