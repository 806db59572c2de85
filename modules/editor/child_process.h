#pragma once

#include <string>
#include <vector>

namespace gnomon {

/// Starts a program without waiting for it to end. p_arguments: the program's name or path, then
/// its arguments. Failure to create a process is an Error; a program that does not exist is not
/// detected.
void start_program(const std::vector<std::string> &p_arguments);

} // namespace gnomon
