#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace gnomon {

/// How the files end that save_file_atomically has not renamed yet. They lie beside the target, and
/// are locked as long as their writer lives: what a killed process left is removed by the next one
/// that saves into the folder.
inline constexpr std::string_view UNFINISHED_FILE_ENDING = ".gnomon_part";

/// Removes the unfinished files in the folder that no living process writes.
void remove_left_over_files(const std::filesystem::path &p_folder);

/// Test hook: called after each step of each save, so that a test can end the process there. An
/// empty function ends that. Returns the hook before.
std::function<void()> set_save_step_hook(std::function<void()> p_hook);

} // namespace gnomon
