#pragma once

// What tests may do to a device. The tests of the backend that the program is linked with define
// it.

#include "modules/rendering_device/rendering_device.h"

namespace gnomon {

/// The next submission that meets the event fails so, once. p_fault is what $GNOMON_INJECT_FAULT
/// may be, see doc/testing.md: "hang", "device_lost@pass:resolve".
void inject_fault(RenderingDevice &r_device, const std::string &p_fault);
/// Lets the submission go on that an injected "hang" holds.
void release_injected_hang(RenderingDevice &r_device);

/// Names of the resources that are alive, "texture 'albedo'", sorted; for the leak tests.
std::vector<std::string> list_live_resources(RenderingDevice &r_device);
uint32_t get_pipeline_count(RenderingDevice &r_device);

/// While it lives, validation messages are collected here and neither counted nor logged. Only for
/// tests that make an error on purpose, to see that the layers notice it. The innermost one
/// collects.
class ExpectedValidationMessages {
public:
	ExpectedValidationMessages();
	~ExpectedValidationMessages();
	ExpectedValidationMessages(const ExpectedValidationMessages &) = delete;
	ExpectedValidationMessages &operator=(const ExpectedValidationMessages &) = delete;
	/// While no other thread uses the device.
	const std::vector<std::string> &get_messages() const { return messages; }

private:
	std::vector<std::string> messages;
	std::vector<std::string> *before = nullptr;
};

} // namespace gnomon
