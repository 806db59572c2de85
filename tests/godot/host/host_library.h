#pragma once

#include <string>

/// Loads a shared library, and returns the address of one of its symbols. Exits with a message if
/// either is missing. Implemented once for each system.
class HostLibrary {
public:
	explicit HostLibrary(const std::string &p_path);
	~HostLibrary(); // unloads it
	HostLibrary(const HostLibrary &) = delete;
	HostLibrary &operator=(const HostLibrary &) = delete;

	void *find_symbol(const char *p_name) const;

private:
	void *handle = nullptr;
};

/// Stops the C library from changing line ends, so that output is equal on all systems.
void make_output_binary();
