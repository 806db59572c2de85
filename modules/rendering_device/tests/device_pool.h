#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <memory>
#include <string>

namespace gnomon {

/// Deleter of TestDevice: destroys the device, or keeps it for another test.
struct TestDeviceDeleter {
	bool is_shared = false;
	void operator()(RenderingDevice *p_device) const;
};
using TestDevice = std::unique_ptr<RenderingDevice, TestDeviceDeleter>;

/// Which device a test gets. ANY: one that an earlier test may have used. NEW: one without
/// pipelines that is destroyed after the test, for tests that count pipelines, replace shaders or
/// make a device fail.
enum class DeviceChoice { ANY, NEW };

/// Returns a device with validation layers. Creating pipelines would take most of the tests' time,
/// so a device that a test has returned, working and without resources, is reused for the next test
/// that requests ANY. p_device: as DeviceOptions::device. If p_device or p_denied is not empty, the
/// device is new.
TestDevice create_test_device(
		DeviceChoice p_choice, const std::string &p_device = "", const FeatureList &p_denied = {});
/// Destroys the devices that are kept for further tests.
void close_test_devices();

} // namespace gnomon
