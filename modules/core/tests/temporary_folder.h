#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gnomon {

/// A new folder, removed by the destructor.
struct TemporaryFolder {
	std::filesystem::path path;
	TemporaryFolder() {
		std::string name = (std::filesystem::temp_directory_path() / "gnomon_test_XXXXXX").string();
		path = ::mkdtemp(name.data());
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
		if (const char *value = std::getenv(variable)) {
			previous_value = value;
		}
		::setenv(variable, path.c_str(), 1);
	}
	~TemporaryUserFolder() {
		if (previous_value.empty()) {
			::unsetenv(variable);
		} else {
			::setenv(variable, previous_value.c_str(), 1);
		}
	}

private:
	const char *variable;
	std::string previous_value;
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
