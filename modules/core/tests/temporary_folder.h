#pragma once

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace gnomon {

/// A folder that vanishes with the test.
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

/// An empty cache folder, so that no test depends on what another one left. Afterwards the cache is
/// where it was before: never the user's own when the test script has chosen one.
struct TemporaryCache : TemporaryFolder {
	TemporaryCache() {
		if (const char *value = std::getenv("GNOMON_CACHE_DIR")) {
			before = value;
		}
		::setenv("GNOMON_CACHE_DIR", path.c_str(), 1);
	}
	~TemporaryCache() {
		if (before.empty()) {
			::unsetenv("GNOMON_CACHE_DIR");
		} else {
			::setenv("GNOMON_CACHE_DIR", before.c_str(), 1);
		}
	}

private:
	std::string before;
};

} // namespace gnomon
