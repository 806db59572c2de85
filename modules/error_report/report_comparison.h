#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace gnomon {

/// A value that differs between two reports by more than their noise.
struct ReportDifference {
	std::string configuration;
	std::string technique;
	std::string setting;
	/// "penumbra error", "receiver error": MAE. "time ratio": cost_ms as a multiple of the
	/// baseline's. "time": cost_ms. "status": 1 measured, 0 failed.
	std::string what;
	double old_value = 0;
	double new_value = 0;
	std::string message; // of a status
	bool is_worse = false;

	bool is_of_time() const { return what == "time" || what == "time ratio"; }
};

struct ReportComparison {
	std::vector<ReportDifference> differences; // worse ones first
	size_t compared_count = 0;				   // cells that both have measured
	size_t only_old_count = 0;				   // cells that only the old report has
	size_t only_new_count = 0;
	bool has_same_machine = true;

	/// True when an error grew, or a cell that was measured now fails or is unusable.
	bool has_regression() const;
};

/// Cells are the same when configuration, technique and setting have the same names, and the
/// images the same size.
///
/// An error differs when the change exceeds 0.0005 + 1 %, plus both standard errors if the
/// references have different numbers of samples. Errors are compared over penumbra pixels, and over
/// all receivers, which also shows leaks in lit areas. A time is compared as a ratio to the
/// baseline of its own report, so that a slower machine alone is no difference. It differs when the
/// change exceeds 15 % and also the sum of the spreads (median to 90th percentile) of all times
/// involved. The baseline, and cells without one, are compared in milliseconds, only on the same
/// machine, and differ when the change exceeds 30 % and also that sum.
ReportComparison compare_reports(const Report &p_old, const Report &p_new);

nlohmann::ordered_json to_json(const ReportComparison &p_comparison);
std::string to_text(const ReportComparison &p_comparison);

} // namespace gnomon
