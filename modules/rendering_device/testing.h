#pragma once

// What tests may do to a device. The backend that the program is linked with defines it; no module
// uses it.

#include "modules/rendering_device/rendering_device.h"

namespace gnomon {

/// Features that a device is to lack, though it may have them.
struct PretendedLimits {
	bool geometry_shader = false;
	bool aliased_memory = false;
	bool depth_clamp = false;
	bool depth_bounds = false;
	bool fragment_stores = false;
	bool storage_texel_buffers = false;
	bool conditional_rendering = false;
	bool subgroup_operations = false;
};
/// As create_rendering_device, of which get_features denies what p_limits names.
std::unique_ptr<RenderingDevice> create_limited_rendering_device(
		const DeviceOptions &p_options, const PretendedLimits &p_limits);

/// What can happen to a submission; $GNOMON_INJECT_FAULT does the same to a program, at an event
/// that does not depend on its speed: "device_lost@pass:resolve", see doc/testing.md.
enum class Fault { NONE, DEVICE_LOST, OUT_OF_MEMORY, HANG };
/// The next submission fails so, once.
void inject_fault(RenderingDevice &r_device, Fault p_fault);
/// Lets the submission go on that an injected Fault::HANG holds.
void release_injected_hang(RenderingDevice &r_device);

/// Names of the resources that are alive, "texture 'albedo'", sorted; for the leak tests.
std::vector<std::string> list_live_resources(RenderingDevice &r_device);

/// While it lives, validation messages are collected here and neither counted nor logged. Only for
/// tests that make a mistake on purpose, to see that the layers notice it. The innermost one
/// collects.
class ExpectedValidationMessages {
public:
	ExpectedValidationMessages();
	~ExpectedValidationMessages();
	ExpectedValidationMessages(const ExpectedValidationMessages &) = delete;
	ExpectedValidationMessages &operator=(const ExpectedValidationMessages &) = delete;
	std::vector<std::string> get_messages() const;

private:
	std::vector<std::string> messages;
	std::vector<std::string> *before = nullptr;
};

} // namespace gnomon
