#include "modules/masks/register_types.h"

namespace gnomon {

// Nothing to register: functions that commands, the report and the editor call.
void initialize_masks_module(ModuleLevel) {}
void uninitialize_masks_module(ModuleLevel) {}

} // namespace gnomon
