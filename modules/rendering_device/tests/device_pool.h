#pragma once

#include "modules/rendering_device/rendering_device.h"

#include <memory>
#include <string>

namespace gnomon {

/// Destroys a device, or keeps it for the next test that borrows one.
struct DeviceReturn {
	bool is_shared = false;
	void operator()(RenderingDevice *p_device) const;
};
using TestDevice = std::unique_ptr<RenderingDevice, DeviceReturn>;

/// Which device a test gets. A new one has made no pipelines and is destroyed after the test: for
/// tests that count pipelines, replace shaders or make a device fail.
enum class DeviceChoice { ANY, NEW };

/// A device under validation. Making pipelines is most of what tests would do, so one that a test
/// has returned, sound and without resources, goes to the next that requests ANY.
/// p_device: as DeviceOptions::device; it and denied features get a new device.
TestDevice create_test_device(
		DeviceChoice p_choice, const std::string &p_device = "", const FeatureList &p_denied = {});
/// Destroys the devices that are retained for further tests.
void close_test_devices();

} // namespace gnomon
