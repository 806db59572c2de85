#include "modules/rendering_device_vulkan/injected_fault.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <algorithm>
#include <map>
#include <regex>

namespace gnomon {

InjectedFault parse_injected_fault(const std::string &p_written) {
	if (p_written.empty()) {
		return {};
	}
	static const std::map<std::string, Fault> KINDS = {
		{ "device_lost", Fault::DEVICE_LOST },
		{ "out_of_memory", Fault::OUT_OF_MEMORY },
		{ "hang", Fault::HANG },
		{ "slow_compilation", Fault::SLOW_COMPILATION },
	};
	static const std::regex PATTERN("([a-z_]+)(?:@pass:(.+)|@file:(.+))?");
	std::smatch matches;
	if (std::regex_match(p_written, matches, PATTERN) && KINDS.contains(matches[1])) {
		return { KINDS.at(matches[1]), matches[2], make_path(matches[3].str()) };
	}
	fail("GNOMON_INJECT_FAULT is \"", p_written,
			"\", must be device_lost, out_of_memory, hang or slow_compilation, alone (the first "
			"submission, or the first pipeline of slow_compilation) or with @pass:NAME (the first "
			"one with a pass, or a pipeline, whose name contains NAME) or @file:PATH (the first "
			"one after that file exists). It is for tests: unset it.");
}

std::optional<std::string> InjectedFault::find_pass(
		const std::vector<std::string> &p_pass_names) const {
	std::error_code ignored; // a file that cannot be accessed counts as absent
	if (fault == Fault::NONE || (!file.empty() && !std::filesystem::exists(file, ignored))) {
		return std::nullopt;
	}
	if (pass.empty()) {
		return p_pass_names.empty() ? std::string() : p_pass_names.back();
	}
	const auto found = std::find_if(p_pass_names.begin(), p_pass_names.end(),
			[&](const std::string &p_name) { return p_name.find(pass) != std::string::npos; });
	return found != p_pass_names.end() ? std::optional(*found) : std::nullopt;
}

} // namespace gnomon
