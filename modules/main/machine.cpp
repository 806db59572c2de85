// What program and processor this is.

#include "modules/core/files.h"
#include "modules/main/commands.h"

#include <fstream>

namespace gnomon {

std::string find_cpu_name() {
	std::ifstream stream("/proc/cpuinfo");
	for (std::string line; std::getline(stream, line);) {
		const size_t colon = line.find(": ");
		if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
			return line.substr(colon + 2);
		}
	}
	return "unknown";
}

std::string describe_program() {
	return std::string(PROGRAM_VERSION) + " " +
			format_hash(compute_hash(load_file("/proc/self/exe")));
}

} // namespace gnomon
