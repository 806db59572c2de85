#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report_plan.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace gnomon {

struct ReportRunOptions {
	/// True: records of an earlier run that was stopped are used, where they belong to this plan.
	/// False: they are removed.
	bool resumes = false;
	/// This run measures the configurations whose index leaves shard_index when divided by
	/// shard_count (along diagonals), and of the stability sweeps whole curves.
	uint32_t shard_index = 0;
	uint32_t shard_count = 1;
	/// Called with what is measured so far, whenever a configuration is complete. May be empty.
	std::function<void(const Report &)> on_progress = {};
};

/// Measures what the plan requests and keeps each result in the store at once. A reference or cell
/// that fails is marked and the rest goes on; a lost device ends it with DeviceLost. Shows its
/// progress.
Report run_report(const ReportPlan &p_plan, MaskSource &r_source, RecordStore &r_store,
		const ReportRunOptions &p_options);

} // namespace gnomon
