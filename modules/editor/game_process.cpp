#include "modules/editor/game_process.h"

#include "modules/core/error.h"

#include <cstdlib>

namespace gnomon {

namespace {

/// As one word for the shell, whatever is in it.
std::string quote(const std::string &p_text) {
	std::string quoted = "'";
	for (const char letter : p_text) {
		quoted += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
	}
	return quoted + "'";
}

} // namespace

void start_game(const std::string &p_program, const std::filesystem::path &p_scene) {
	// By the shell, so that the game is nobody's child when it ends.
	const std::string command =
			quote(p_program) + " run " + quote(p_scene.string()) + " >/dev/null 2>&1 &";
	if (std::system(command.c_str()) != 0) {
		fail("The game cannot be started. Run: ", p_program, " run ", p_scene.string());
	}
}

} // namespace gnomon
