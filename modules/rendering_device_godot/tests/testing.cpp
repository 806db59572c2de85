#include "modules/rendering_device/tests/testing.h"

#include "modules/core/error.h"
#include "modules/rendering_device_godot/godot_device.h"

#include <algorithm>

namespace gnomon {

namespace {

GodotDevice &get_godot_device(RenderingDevice &r_device) {
	return static_cast<GodotDevice &>(r_device); // the only backend of this library
}

} // namespace

void inject_fault(RenderingDevice &, const std::string &) {
	fail("Faults cannot be injected into a device of Godot.");
}

void release_injected_hang(RenderingDevice &) {}

std::vector<std::string> list_live_resources(RenderingDevice &r_device) {
	std::vector<std::string> names = get_godot_device(r_device).list_live_resources();
	std::sort(names.begin(), names.end());
	return names;
}

uint32_t get_pipeline_count(RenderingDevice &r_device) {
	return get_godot_device(r_device).get_pipeline_count();
}

// They collect nothing: Godot logs errors itself, and tests/godot/test_godot.py fails if it did.
ExpectedValidationMessages::ExpectedValidationMessages() = default;
ExpectedValidationMessages::~ExpectedValidationMessages() = default;

} // namespace gnomon
