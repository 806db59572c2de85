#include "modules/stability_report/stability_result.h"

#include "modules/core/error.h"
#include "modules/stability_report/stability_part.h"

#include <nlohmann/json.hpp>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

ErrorCause parse_cause(const std::string &p_name) {
	for (const ErrorCause cause :
			{ ErrorCause::METHOD, ErrorCause::ROUNDING, ErrorCause::REFERENCE }) {
		if (p_name == get_name(cause)) {
			return cause;
		}
	}
	if (p_name == "truth") { // the reference, in version 1
		return ErrorCause::REFERENCE;
	}
	fail("cause is \"", p_name, "\", must be method, rounding or reference_mask.");
}

VisibilityCondition read_condition(const Json &p_json) {
	// Version 1 called the reference "truth".
	const bool is_version_1 = p_json.contains("truth_error");
	return { p_json.at("number"), p_json.at("rounding"),
		p_json.at(is_version_1 ? "truth_error" : "reference_error"), p_json.at("error"),
		parse_cause(p_json.at("cause")) };
}

} // namespace

Json StabilityResult::to_json() const {
	Json json = { { "wrong_share", wrong_share }, { "warnings", warnings },
		{ "refusal", refusal } };
	if (temporal_rmse) {
		json["temporal_rmse"] = *temporal_rmse;
	}
	if (condition) {
		json["condition"] = { { "number", condition->number }, { "rounding", condition->rounding },
			{ "reference_error", condition->reference_error }, { "error", condition->error },
			{ "cause", get_name(condition->cause) } };
	}
	return json;
}

std::shared_ptr<const PartResult> StabilityPart::read_result(const Json &p_json) const {
	auto result = std::make_shared<StabilityResult>();
	result->wrong_share = p_json.at("wrong_share");
	p_json.at("warnings").get_to(result->warnings);
	p_json.at("refusal").get_to(result->refusal);
	if (p_json.contains("temporal_rmse")) {
		result->temporal_rmse = p_json.at("temporal_rmse").get<double>();
	}
	if (p_json.contains("condition")) {
		result->condition = read_condition(p_json.at("condition"));
	}
	return result;
}

} // namespace gnomon
