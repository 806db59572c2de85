#include "modules/gltf_scene/register_types.h"

namespace gnomon {

// Nothing to register: load_gltf and save_gltf keep no state.
void initialize_gltf_scene_module(ModuleLevel) {}
void uninitialize_gltf_scene_module(ModuleLevel) {}

} // namespace gnomon
