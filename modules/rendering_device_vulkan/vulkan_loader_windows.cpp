#include "modules/core/error.h"
#include "modules/rendering_device_vulkan/vulkan_loader.h"

#define WIN32_LEAN_AND_MEAN
#define NOGDI // wingdi.h defines ERROR, a name of LogLevel
#include <windows.h>

void gnomon::check_vulkan_loader() {
	// It stays loaded: every later call of a function of Vulkan uses it.
	static const HMODULE loader = ::LoadLibraryW(L"vulkan-1.dll");
	if (loader == nullptr) {
		fail("Vulkan does not start: this system has no vulkan-1.dll. Install the current driver "
			 "of "
			 "your graphics card, which contains it.");
	}
}
