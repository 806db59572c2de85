#pragma once

#include <string>
#include <vector>

namespace gnomon {

/// Starts a program with its arguments and returns without waiting for it to end. It is an Error if
/// no process can be created; a program that does not exist is not detected.
void start_program(const std::vector<std::string> &p_words);

} // namespace gnomon
