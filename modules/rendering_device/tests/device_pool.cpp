#include "modules/rendering_device/tests/device_pool.h"

#include "modules/core/error.h"
#include "modules/core/operating_system.h"
#include "modules/rendering_device/tests/testing.h"

#include <vector>

namespace gnomon {

namespace {

std::vector<std::unique_ptr<RenderingDevice>> idle_devices;

/// Returns whether the device still works and has no live resources.
bool is_reusable(RenderingDevice &r_device) {
	try {
		r_device.abandon_commands();
		r_device.wait_idle();
		r_device.begin_commands(); // collects what was freed
		r_device.submit_commands(RenderingDevice::SubmitMode::WAIT);
		return list_live_resources(r_device).empty();
	} catch (const Error &) {
		return false; // lost
	}
}

} // namespace

void TestDeviceDeleter::operator()(RenderingDevice *p_device) const {
	std::unique_ptr<RenderingDevice> device(p_device);
	if (device && is_shared && is_reusable(*device)) {
		idle_devices.push_back(std::move(device));
	}
}

TestDevice create_test_device(
		DeviceChoice p_choice, const std::string &p_device, const FeatureList &p_denied) {
	const bool is_shared = p_choice == DeviceChoice::ANY && p_device.empty() && p_denied.empty();
	if (is_shared && !idle_devices.empty()) {
		std::unique_ptr<RenderingDevice> device = std::move(idle_devices.back());
		idle_devices.pop_back();
		return TestDevice(device.release(), { /*is_shared=*/true });
	}
	DeviceOptions options;
	options.validation = wants_validation();
	options.device = p_device;
	options.denied_features = p_denied;
	return TestDevice(create_rendering_device(options).release(), { is_shared });
}

bool wants_validation() {
	return get_environment_variable("GNOMON_TEST_VALIDATION") != "external";
}

void close_test_devices() {
	idle_devices.clear();
}

} // namespace gnomon
