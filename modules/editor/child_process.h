#pragma once

#include <string>
#include <vector>

namespace gnomon {

/// Starts a program with its arguments and returns at once; nobody waits for it. An Error when no
/// process can be made; that there is no such program only it could tell, and nobody listens.
void start_program(const std::vector<std::string> &p_words);

} // namespace gnomon
