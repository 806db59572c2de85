#include "tests/godot/host/host_library.h"

#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

HostLibrary::HostLibrary(const std::string &p_path) :
		handle(::dlopen(p_path.c_str(), RTLD_NOW | RTLD_LOCAL)) {
	if (!handle) {
		std::fprintf(stderr, "ERROR: %s\n", ::dlerror());
		std::exit(1);
	}
}

HostLibrary::~HostLibrary() {
	::dlclose(handle);
}

void *HostLibrary::find_symbol(const char *p_name) const {
	void *address = ::dlsym(handle, p_name);
	if (!address) {
		std::fprintf(stderr, "ERROR: %s\n", ::dlerror());
		std::exit(1);
	}
	return address;
}

void make_output_binary() {}
