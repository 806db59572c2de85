#pragma once

// Operations on a device that only tests may use. The tests of the backend that is linked into the
// program define them.

#include "modules/rendering_device/rendering_device.h"

namespace gnomon {

/// Makes the next submission that meets the condition fail, once. p_fault: a value of
/// $GNOMON_INJECT_FAULT, see doc/testing.md: "hang", "device_lost@pass:resolve".
void inject_fault(RenderingDevice &r_device, const std::string &p_fault);
/// Resumes the submission that an injected "hang" blocks.
void release_injected_hang(RenderingDevice &r_device);

/// Returns whether tests request validation layers: always, unless $GNOMON_TEST_VALIDATION is
/// "external", because they are switched on from outside of the program, as under Wine, whose
/// programs see no layers.
bool wants_validation();

/// Names of the resources that are alive, "texture 'albedo'", sorted; for the leak tests.
std::vector<std::string> list_live_resources(RenderingDevice &r_device);
uint32_t get_pipeline_count(RenderingDevice &r_device);

/// Collects validation messages during its lifetime; they are neither counted nor logged. Only for
/// tests that cause an error on purpose, to check that the layers report it. If several exist, the
/// one that was created last collects.
class ExpectedValidationMessages {
public:
	ExpectedValidationMessages();
	~ExpectedValidationMessages();
	ExpectedValidationMessages(const ExpectedValidationMessages &) = delete;
	ExpectedValidationMessages &operator=(const ExpectedValidationMessages &) = delete;
	/// Call it only while no other thread uses the device.
	const std::vector<std::string> &get_messages() const { return messages; }

private:
	std::vector<std::string> messages;
	std::vector<std::string> *before = nullptr;
};

} // namespace gnomon
