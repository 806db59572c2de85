#pragma once

#include "modules/core/command_registry.h"

namespace gnomon {

/// `gnomon compare`, see CommandInfo::add.
void add_compare_command(CLI::App &r_app, CommonOptions &r_common);

} // namespace gnomon
