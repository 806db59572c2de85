#include "modules/editor/child_process.h"

#include "modules/core/error.h"

#include <cstdlib>

namespace gnomon {

namespace {

/// Quotes any text as one word for the shell.
std::string quote(const std::string &p_text) {
	std::string quoted = "'";
	for (const char letter : p_text) {
		quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
	}
	return quoted + "'";
}

} // namespace

void start_program(const std::vector<std::string> &p_words) {
	std::string command;
	for (const std::string &word : p_words) {
		command += quote(word) + " ";
	}
	// Runs in the shell's background, so that it leaves no zombie process when it ends.
	if (std::system((command + ">/dev/null 2>&1 &").c_str()) != 0) {
		fail("No process can be started. Run it yourself: ", command);
	}
}

} // namespace gnomon
