// Saves a file, and can be ended at any step of it, so that tests/platforms/test_saves.py can test
// what a killed process leaves, on every system.
//
//     save_steps FOLDER NAME LETTER MEGABYTES end STEP     ends the process after that step
//     save_steps FOLDER NAME LETTER MEGABYTES wait STEP    waits there for a line of the input
//     save_steps FOLDER NAME LETTER MEGABYTES              saves
//     save_steps FOLDER NAME hold                          opens the file, and waits for a line
//
// The name may be "long", of 255 bytes, or "too_long", of 256. The name of every file begins
// with letters outside of ASCII. Prints the count of steps. Exit code: 0, 1 after an error, 3 where
// the process ended itself.

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

namespace {

std::filesystem::path make_path(const std::string &p_folder, const std::string &p_name) {
	std::filesystem::path name(u"gnömon ❤ ");
	if (p_name == "long" || p_name == "too_long") {
		// In bytes, as the file systems of Linux count, which Wine uses too.
		const size_t length_bytes = p_name == "long" ? 255 : 256;
		name += std::string(length_bytes - name.u8string().size(), 'n');
	} else {
		name += p_name;
	}
	return std::filesystem::path(p_folder) / name;
}

void wait_for_line() {
	std::puts("waiting");
	std::fflush(stdout);
	std::getchar();
}

} // namespace

int main(int p_count, char **p_arguments) {
	if (p_count == 4) {
		const std::ifstream file(make_path(p_arguments[1], p_arguments[2]));
		wait_for_line();
		return 0;
	}
	if (p_count != 5 && p_count != 7) {
		std::fprintf(stderr, "Usage: save_steps FOLDER NAME LETTER MEGABYTES [end|wait STEP]\n");
		return 2;
	}
	const std::string what = p_count == 7 ? p_arguments[5] : "";
	const int last_step = p_count == 7 ? std::atoi(p_arguments[6]) : 0;
	int step_count = 0;
	gnomon::set_save_step_hook([&] {
		if (++step_count == last_step && what == "end") {
			std::_Exit(3); // runs no destructor, as if the process were killed
		}
		if (step_count == last_step && what == "wait") {
			wait_for_line();
		}
	});
	try {
		const size_t size_bytes = static_cast<size_t>(std::atof(p_arguments[4]) * (1 << 20));
		gnomon::save_file_atomically(make_path(p_arguments[1], p_arguments[2]),
				std::string(size_bytes, p_arguments[3][0]));
	} catch (const gnomon::Error &error) {
		std::fprintf(stderr, "ERROR: %s\n", error.what());
		return 1;
	}
	std::printf("%d steps\n", step_count);
	return 0;
}
