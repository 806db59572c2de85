#pragma once

#include <filesystem>
#include <string>

namespace gnomon {

/// Starts `PROGRAM run SCENE` in a window of its own and returns at once. An Error when no process
/// can be made.
void start_game(const std::string &p_program, const std::filesystem::path &p_scene);

} // namespace gnomon
