#include "modules/error_report/register_types.h"

namespace gnomon {

// Nothing to register: functions that the command line calls.
void initialize_error_report_module(ModuleLevel) {}
void uninitialize_error_report_module(ModuleLevel) {}

} // namespace gnomon
