// A library that Godot loads. It runs the tests on Godot's RenderingDevice and ends Godot with
// their exit code. $GNOMON_TEST_ARGUMENTS has doctest's arguments, one per line.

#include "modules/core/error.h"
#include "modules/rendering_device_godot/godot_interface.h"

#include "tests/test_runner.h"

#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

int run() {
	std::vector<std::string> arguments = { "gnomon_tests" };
	const char *given = std::getenv("GNOMON_TEST_ARGUMENTS");
	std::istringstream lines(given ? given : "");
	for (std::string line; std::getline(lines, line);) {
		arguments.push_back(line);
	}
	std::vector<char *> pointers;
	for (std::string &argument : arguments) {
		pointers.push_back(argument.data());
	}
	return run_tests(static_cast<int>(pointers.size()), pointers.data());
}

void initialize(void *, GDExtensionInitializationLevel p_level) {
	if (p_level == GDEXTENSION_INITIALIZATION_SCENE) {
		GDExtensionMainLoopCallbacks callbacks = {};
		callbacks.startup_func = [] { // now the RenderingServer exists
			const int result = run();
			std::cout.flush();
			std::fflush(nullptr);
			std::_Exit(result);
		};
		const gnomon::godot::Interface &interface = gnomon::godot::get_interface();
		interface.register_main_loop_callbacks(interface.extension, &callbacks);
	}
}

void uninitialize(void *, GDExtensionInitializationLevel) {}

} // namespace

extern "C" __attribute__((visibility("default"))) GDExtensionBool gnomon_tests_init(
		GDExtensionInterfaceGetProcAddress p_get_address, GDExtensionClassLibraryPtr p_library,
		GDExtensionInitialization *r_initialization) {
	try {
		gnomon::godot::load_interface(p_get_address, p_library);
	} catch (const gnomon::Error &error) {
		std::fprintf(stderr, "%s\n", error.what());
		return 0;
	}
	r_initialization->minimum_initialization_level = GDEXTENSION_INITIALIZATION_SCENE;
	r_initialization->initialize = initialize;
	r_initialization->deinitialize = uninitialize;
	return 1;
}
