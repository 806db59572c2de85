#include "modules/shadows/frame_plan.h"

#include "modules/core/text.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace gnomon {

void FramePlan::run(const std::string &p_pass) {
	entries.push_back({ light, p_pass, /*runs=*/true, /*reason=*/{} });
}

void FramePlan::skip(const std::string &p_pass, const std::string &p_reason) {
	entries.push_back({ light, p_pass, /*runs=*/false, p_reason });
}

bool FramePlan::is_skipped(const std::string &p_light, const std::string &p_pass) const {
	return std::any_of(entries.begin(), entries.end(), [&](const FramePlanEntry &p_entry) {
		return !p_entry.runs && p_entry.light == p_light && p_entry.pass == p_pass;
	});
}

std::string FramePlan::to_text() const {
	std::string lines;
	for (const FramePlanEntry &entry : entries) {
		lines += text(entry.light.empty() ? "frame" : entry.light, ": ", entry.pass, ": ",
				entry.runs ? "runs" : "skipped, " + entry.reason, "\n");
	}
	return lines;
}

std::string FramePlan::to_json() const {
	nlohmann::json json = nlohmann::json::array();
	for (const FramePlanEntry &entry : entries) {
		json.push_back({ { "light", entry.light }, { "pass", entry.pass }, { "runs", entry.runs },
				{ "reason", entry.reason } });
	}
	return json.dump();
}

} // namespace gnomon
