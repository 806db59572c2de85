#pragma once

#include <string>
#include <vector>

namespace gnomon {

/// Starts a program with its arguments and returns immediately, without waiting for it to end. An
/// Error when no process can be created; a program that does not exist is not detected.
void start_program(const std::vector<std::string> &p_words);

} // namespace gnomon
