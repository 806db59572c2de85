#pragma once

#include <filesystem>
#include <optional>
#include <string>

// What differs between operating systems; operating_system_posix.cpp and
// operating_system_windows.cpp implement it. All text is UTF-8.

namespace gnomon {

/// Returns the value of an environment variable, or nothing if it is absent or empty.
std::optional<std::string> get_environment_variable(const char *p_name);

enum class UserFolderKind { CACHE, CONFIG };

/// Returns the folder of Gnomon's files of a kind for the current user, which may not exist, or an
/// empty path if the system names none. Linux: $XDG_CACHE_HOME/gnomon or ~/.cache/gnomon,
/// $XDG_CONFIG_HOME/gnomon or ~/.config/gnomon. Windows: %LOCALAPPDATA%\gnomon\cache or \config.
std::filesystem::path find_system_user_folder(UserFolderKind p_kind);

/// Returns whether files can be created in the folder. False if it is no folder.
bool is_folder_writable(const std::filesystem::path &p_folder);

/// Returns whether stderr is a terminal that obeys escape sequences.
bool is_error_output_terminal();

/// Returns the path of the running program, or an empty path if the system does not tell.
std::filesystem::path find_program_path();

/// Returns the processor's model name, or "unknown".
std::string find_cpu_name();

/// Returns the CPU time that the calling thread has used, in ms, without time in which it waited.
/// Windows counts in steps of about 16 ms.
double read_thread_time_ms();

} // namespace gnomon
