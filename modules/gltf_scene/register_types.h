#pragma once

#include "modules/core/module_registry.h"

namespace gnomon {

void initialize_gltf_scene_module(ModuleLevel p_level);
void uninitialize_gltf_scene_module(ModuleLevel p_level);

} // namespace gnomon
