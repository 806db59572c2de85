#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report_plan.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace gnomon {

struct RunOptions {
	/// True: records of an earlier run that was stopped are used, where they belong to this plan.
	/// False: they are removed.
	bool resumes = false;
	/// This run measures the configurations whose index leaves shard_index when divided by
	/// shard_count.
	uint32_t shard_index = 0;
	uint32_t shard_count = 1;
};

/// Measures what the plan asks for and keeps each result in the store at once. A truth or cell that
/// fails is marked and the rest goes on. Shows its progress.
Report run_report(const ReportPlan &p_plan, MaskSource &r_source, RecordStore &r_store,
		const RunOptions &p_options);

/// The report of a plan with what a store holds of it; the rest stays missing.
Report collect_report(const Report &p_plan, const RecordStore &p_store);

/// Puts the records of several stores, parts of one plan, into one. The folders are those of
/// reports, with plan.json and cells. Folders whose plans differ are an Error naming two of them.
Report merge_reports(
		const std::vector<std::filesystem::path> &p_folders, const std::filesystem::path &p_out);

/// Where in a report's folder its plan and its records lie.
std::filesystem::path get_plan_path(const std::filesystem::path &p_folder);
std::filesystem::path get_record_folder(const std::filesystem::path &p_folder);
void save_plan(const std::filesystem::path &p_folder, const Report &p_report);

} // namespace gnomon
