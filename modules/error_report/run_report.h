#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report_plan.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gnomon {

struct ReportRunOptions {
	/// True: records of an interrupted run are used when they belong to this plan. False: they are
	/// removed.
	bool resumes = false;
	/// This run measures the configurations whose index modulo shard_count is shard_index (along
	/// diagonals of the matrix); stability sweeps are split by whole curves.
	uint32_t shard_index = 0;
	uint32_t shard_count = 1;
	/// Called with the results so far whenever a configuration is complete. May be empty.
	std::function<void(const Report &)> on_progress = {};
};

/// Runs the plan and stores each result immediately. A reference or cell that fails is marked, and
/// the run continues; a lost device ends it with DeviceLost. Prints its progress.
Report run_report(const ReportPlan &p_plan, MaskSource &r_source, RecordStore &r_store,
		const ReportRunOptions &p_options);

} // namespace gnomon
