#pragma once

#include "modules/core/command_registry.h"

namespace gnomon {

/// Adds the subcommand `gnomon compare` to the parser; used as CommandInfo::add.
void add_compare_command(CLI::App &r_app, CommonOptions &r_common);

} // namespace gnomon
