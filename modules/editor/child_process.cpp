#include "modules/editor/child_process.h"

#include "modules/core/error.h"

#include <cstdlib>

namespace gnomon {

namespace {

/// Quotes any text as a single argument for the shell.
std::string quote(const std::string &p_text) {
	std::string quoted = "'";
	for (const char letter : p_text) {
		quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
	}
	return quoted + "'";
}

} // namespace

void start_program(const std::vector<std::string> &p_arguments) {
	std::string command;
	for (const std::string &argument : p_arguments) {
		command += quote(argument) + " ";
	}
	// The shell starts it in the background, so that it leaves no zombie process when it ends.
	if (std::system((command + ">/dev/null 2>&1 &").c_str()) != 0) {
		fail("Cannot start a process. Run the command yourself: ", command);
	}
}

} // namespace gnomon
