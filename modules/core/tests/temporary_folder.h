#pragma once

#include "modules/core/files.h"
#include "modules/core/operating_system.h"

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>

namespace gnomon {

/// Sets an environment variable of this process, or removes it if p_value is empty.
inline void set_environment_variable(const char *p_name, const std::filesystem::path &p_value) {
#ifdef _WIN32
	::_wputenv_s(std::filesystem::path(p_name).c_str(), p_value.c_str());
#else
	p_value.empty() ? ::unsetenv(p_name) : ::setenv(p_name, p_value.c_str(), 1);
#endif
}

/// A new folder, removed by the destructor.
struct TemporaryFolder {
	std::filesystem::path path;
	TemporaryFolder() {
		std::random_device random;
		do {
			const std::string name =
					"gnomon_test_" + format_hash(uint64_t(random()) << 32 | random());
			path = std::filesystem::temp_directory_path() / name;
		} while (!std::filesystem::create_directory(path));
	}
	~TemporaryFolder() { std::filesystem::remove_all(path); }
	TemporaryFolder(const TemporaryFolder &) = delete;
	TemporaryFolder &operator=(const TemporaryFolder &) = delete;
};

/// Sets an environment variable to a new folder, so that no test depends on files of another test.
/// The destructor restores the variable's previous value, so that later tests use the folder that
/// the test script chose and never the user's own.
struct TemporaryUserFolder : TemporaryFolder {
	explicit TemporaryUserFolder(const char *p_variable) : variable(p_variable) {
		previous_value = make_path(get_environment_variable(variable).value_or(""));
		set_environment_variable(variable, path);
	}
	~TemporaryUserFolder() { set_environment_variable(variable, previous_value); }

private:
	const char *variable;
	std::filesystem::path previous_value;
};

/// Replaces the folder of get_cache_folder.
struct TemporaryCache : TemporaryUserFolder {
	TemporaryCache() : TemporaryUserFolder("GNOMON_CACHE_DIR") {}
};

/// Replaces the folder of get_config_folder.
struct TemporaryConfig : TemporaryUserFolder {
	TemporaryConfig() : TemporaryUserFolder("GNOMON_CONFIG_DIR") {}
};

} // namespace gnomon
