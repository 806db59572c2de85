#pragma once

#include "modules/core/command_registry.h"

namespace gnomon {

/// `gnomon edit`, see CommandInfo::add.
void add_edit_command(CLI::App &r_app, CommonOptions &r_common);

} // namespace gnomon
