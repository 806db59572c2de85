#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

enum class Fault { NONE, DEVICE_LOST, OUT_OF_MEMORY, HANG, SLOW_COMPILATION };

/// A fault for tests. It is injected once, into the first submission that meets all conditions that
/// are set. SLOW_COMPILATION is injected into the first pipeline instead, whose name takes the
/// place of the pass.
struct InjectedFault {
	Fault fault = Fault::NONE;
	std::string pass;			// substring of the name of one of its passes
	std::filesystem::path file; // file that must exist at submission

	/// Returns the first pass that meets the condition. If `pass` is empty, returns the last pass,
	/// or an empty name if there are no passes. Returns nothing if the fault does not apply.
	std::optional<std::string> find_pass(const std::vector<std::string> &p_pass_names) const;
};
/// Parses $GNOMON_INJECT_FAULT; empty: no fault. An unknown value is an Error that lists the known
/// ones.
InjectedFault parse_injected_fault(const std::string &p_written);

} // namespace gnomon
