#include "modules/core/operating_system.h"

#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <fstream>

namespace gnomon {

namespace fs = std::filesystem;

std::optional<std::string> get_environment_variable(const char *p_name) {
	const char *value = std::getenv(p_name);
	return value != nullptr && *value != 0 ? std::optional<std::string>(value) : std::nullopt;
}

fs::path find_system_user_folder(UserFolderKind p_kind) {
	const bool is_cache = p_kind == UserFolderKind::CACHE;
	if (const auto shared =
					get_environment_variable(is_cache ? "XDG_CACHE_HOME" : "XDG_CONFIG_HOME")) {
		return fs::path(*shared) / "gnomon";
	}
	if (const auto home = get_environment_variable("HOME")) {
		return fs::path(*home) / (is_cache ? ".cache" : ".config") / "gnomon";
	}
	return {};
}

bool is_folder_writable(const fs::path &p_folder) {
	std::error_code code;
	return fs::is_directory(p_folder, code) && ::access(p_folder.c_str(), W_OK) == 0;
}

bool is_error_output_terminal() {
	return ::isatty(STDERR_FILENO) != 0;
}

fs::path find_program_path() {
	std::error_code code;
	return fs::read_symlink("/proc/self/exe", code); // a chroot may lack /proc
}

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

double read_thread_time_ms() {
	timespec time = {};
	::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
	return double(time.tv_sec) * 1e3 + double(time.tv_nsec) / 1e6;
}

} // namespace gnomon
