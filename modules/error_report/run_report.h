#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report_plan.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gnomon {

/// Options of run_report.
struct ReportRunOptions {
	/// True: reuses the records of an interrupted run; what failed there is measured again. False:
	/// deletes this shard's records and those of other plans.
	bool resumes = false;
	/// This run measures shard shard_index, from 0, of shard_count of the plan. Configurations are
	/// assigned by index, sweeps of report parts by whole curves; see is_in_shard in
	/// run_report.cpp.
	uint32_t shard_index = 0;
	uint32_t shard_count = 1;
	/// Called with the results so far, after each configuration of which cells were measured. May
	/// be empty.
	std::function<void(const Report &)> on_progress = {};
};

/// Measures the plan and returns the report. Each result is stored at once as a record. A reference
/// or cell that fails gets the status FAILED, and the run continues; a lost device ends it with
/// DeviceLost. Prints its progress.
Report run_report(const ReportPlan &p_plan, MaskSource &r_source, RecordStore &r_store,
		const ReportRunOptions &p_options);

} // namespace gnomon
