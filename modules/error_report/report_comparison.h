#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gnomon {

/// A value of a cell that differs between two reports by more than the noise.
struct ReportDifference {
	std::string configuration;
	std::string technique;
	std::string setting;
	/// The compared quantity. "penumbra error", "receiver error": mean absolute error. "time
	/// ratio": cost_ms divided by that of the baseline. "time": cost_ms. "status": 1 measured, 0
	/// failed or unusable.
	std::string what;
	double old_value = 0;
	double new_value = 0;
	/// Error message of a worse "status"; empty if the mask is unusable, and in all other cases.
	std::string message;
	bool is_worse = false;

	bool is_of_time() const { return what == "time" || what == "time ratio"; }
};

struct ReportComparison {
	std::vector<ReportDifference> differences; // the worse ones first
	size_t compared_count = 0;				   // cells measured successfully in both reports
	size_t only_old_count = 0;				   // cells that only the old report has
	size_t only_new_count = 0;				   // cells that only the new report has
	bool has_same_machine = true;			   // the machines of both reports are equal

	/// Returns true if an error grew, or if a cell that was measured now fails or is unusable (see
	/// ReportPart::find_problem). A longer time is no regression.
	bool has_regression() const;
};

/// Compares two reports cell by cell. Two cells correspond if configuration, technique and setting
/// have the same names and the images the same size.
///
/// Errors are compared over penumbra pixels, and over all receivers, which also shows light leaks
/// outside penumbras. An error differs if it changes by more than 0.0005 plus 1 % of the old value,
/// plus both standard errors if the references have different numbers of samples.
///
/// Times are compared as ratios to the baseline of their own report, so that a slower machine alone
/// is no difference. A ratio differs if it changes by more than 15 %, and by more than the sum of
/// the relative spreads (90th percentile minus median, divided by the median) of its times: those
/// of cell and baseline in both reports. Times of the baseline and of cells without a baseline are
/// compared in milliseconds, only if measured on the same machine. They differ if they change by
/// more than 30 % and by more than the sum of the spreads.
ReportComparison compare_reports(const Report &p_old, const Report &p_new);

/// Returns the value of "against" in report.json.
nlohmann::ordered_json to_json(const ReportComparison &p_comparison);
/// Returns a summary line and one line per difference, for the console.
std::string to_text(const ReportComparison &p_comparison);

} // namespace gnomon
