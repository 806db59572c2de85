#include "modules/editor/register_types.h"

#include "modules/editor/command_edit.h"

namespace gnomon {

void initialize_editor_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		CommandRegistry::add({ "edit", &add_edit_command });
	}
}

void uninitialize_editor_module(ModuleLevel p_level) {
	if (p_level == ModuleLevel::FEATURES) {
		CommandRegistry::remove("edit");
	}
}

} // namespace gnomon
