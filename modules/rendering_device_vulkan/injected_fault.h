#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gnomon {

enum class Fault { NONE, DEVICE_LOST, OUT_OF_MEMORY, HANG };

/// Happens once, to the first submission for which all conditions hold that are set.
struct InjectedFault {
	Fault fault = Fault::NONE;
	std::string pass;			// contained in the name of one of its passes
	std::filesystem::path file; // exists when it is submitted

	/// The pass that meets the condition, else the last one; nothing where it is not due.
	std::optional<std::string> find_pass(const std::vector<std::string> &p_pass_names) const;
};
/// Of $GNOMON_INJECT_FAULT, empty: none. A value that is none is an Error with those that are.
InjectedFault parse_injected_fault(const std::string &p_written);

} // namespace gnomon
