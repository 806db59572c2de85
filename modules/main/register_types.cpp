#include "modules/main/register_types.h"

#include "modules/core/command_registry.h"
#include "modules/main/commands.h"

namespace gnomon {

void initialize_main_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		CommandRegistry::add({ "run", &add_run_command, /*help_order=*/0 });
		register_list_commands();
		initialize_optional_parts();
	}
}

void uninitialize_main_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		uninitialize_optional_parts();
		unregister_list_commands();
		CommandRegistry::remove("run");
	}
}

} // namespace gnomon
