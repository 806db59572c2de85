#pragma once

#include "modules/error_report/report_plan.h"

#include <functional>

namespace gnomon {

/// Calls for each point of the sweeps that the options ask for, the centre of a curve before its
/// other points.
void plan_stability(const ReportOptions &p_options,
		const std::function<void(ReportConfiguration, ReportPlan::Ask)> &p_add);

} // namespace gnomon
