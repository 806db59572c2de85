#include "modules/rendering_device_vulkan/injected_fault.h"

#include "modules/core/error.h"

#include <algorithm>
#include <cstdlib>

namespace gnomon {

InjectedFault read_injected_fault() {
	const char *value = std::getenv("GNOMON_INJECT_FAULT");
	if (value == nullptr || *value == 0) {
		return {};
	}
	static const std::pair<std::string_view, Fault> KINDS[] = {
		{ "device_lost", Fault::DEVICE_LOST },
		{ "out_of_memory", Fault::OUT_OF_MEMORY },
		{ "hang", Fault::HANG },
	};
	static constexpr std::string_view PASS = "@pass:";
	static constexpr std::string_view FILE = "@file:";
	const std::string_view written(value);
	const size_t at = std::min(written.find('@'), written.size());
	const std::string_view event = written.substr(at);
	for (const auto &[name, fault] : KINDS) {
		if (name != written.substr(0, at)) {
			continue;
		}
		if (event.empty()) {
			return { fault, {}, {} };
		}
		if (event.starts_with(PASS) && event.size() > PASS.size()) {
			return { fault, std::string(event.substr(PASS.size())), {} };
		}
		if (event.starts_with(FILE) && event.size() > FILE.size()) {
			return { fault, {}, event.substr(FILE.size()) };
		}
	}
	fail("GNOMON_INJECT_FAULT is \"", written, "\", must be device_lost, out_of_memory or hang, ",
			"alone (the first submission) or with @pass:NAME (the first one with a pass whose "
			"name contains NAME) or @file:PATH (the first one after that file exists). It is for "
			"tests: unset it.");
}

std::optional<std::string> InjectedFault::find_pass(
		const std::vector<std::string> &p_pass_names) const {
	std::error_code ignored; // a file that cannot be looked at is none
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
