#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gnomon {

/// A folder that is removed at the end of the test.
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

/// An empty folder in an environment variable, so that no test depends on what another one left.
/// Afterwards the variable has its previous value, so that a folder that the test script has chosen
/// is used again, and never the user's own.
struct TemporaryUserFolder : TemporaryFolder {
	explicit TemporaryUserFolder(const char *p_variable) : variable(p_variable) {
		if (const char *value = std::getenv(variable)) {
			before = value;
		}
		::setenv(variable, path.c_str(), 1);
	}
	~TemporaryUserFolder() {
		if (before.empty()) {
			::unsetenv(variable);
		} else {
			::setenv(variable, before.c_str(), 1);
		}
	}

private:
	const char *variable;
	std::string before;
};

struct TemporaryCache : TemporaryUserFolder {
	TemporaryCache() : TemporaryUserFolder("GNOMON_CACHE_DIR") {}
};

struct TemporaryConfig : TemporaryUserFolder {
	TemporaryConfig() : TemporaryUserFolder("GNOMON_CONFIG_DIR") {}
};

} // namespace gnomon
