#pragma once

#include "modules/core/command_registry.h"

namespace gnomon {

/// Adds the subcommand `gnomon edit` to the parser. This is its CommandInfo::add.
void add_edit_command(CLI::App &r_app, CommonOptions &r_common);

} // namespace gnomon
