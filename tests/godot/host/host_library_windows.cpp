#include "tests/godot/host/host_library.h"

#define WIN32_LEAN_AND_MEAN
#define NOGDI
#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <cstdio>
#include <cstdlib>

HostLibrary::HostLibrary(const std::string &p_path) : handle(::LoadLibraryA(p_path.c_str())) {
	if (!handle) {
		std::fprintf(
				stderr, "ERROR: LoadLibrary of %s: error %lu\n", p_path.c_str(), ::GetLastError());
		std::exit(1);
	}
}

HostLibrary::~HostLibrary() {
	::FreeLibrary(static_cast<HMODULE>(handle));
}

void *HostLibrary::find_symbol(const char *p_name) const {
	void *address =
			reinterpret_cast<void *>(::GetProcAddress(static_cast<HMODULE>(handle), p_name));
	if (!address) {
		std::fprintf(stderr, "ERROR: the library has no symbol %s\n", p_name);
		std::exit(1);
	}
	return address;
}

void make_output_binary() {
	::_setmode(::_fileno(stdout), _O_BINARY);
}
