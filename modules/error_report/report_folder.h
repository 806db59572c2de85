#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

// Return the path of plan.json, and of the folder of records, in a report's folder.
std::filesystem::path get_plan_path(const std::filesystem::path &p_folder);
std::filesystem::path get_record_folder(const std::filesystem::path &p_folder);
/// Returns the names of all records of the plan: references, scene images and cells.
std::vector<std::string> list_records(const Report &p_plan);

/// Writes plan.json.
void save_plan(const std::filesystem::path &p_folder, const Report &p_plan);
/// Throws an Error if the folder contains a plan that differs from p_plan, since records of
/// different plans must not be mixed. A folder without a plan is valid.
void check_resumable(const std::filesystem::path &p_folder, const Report &p_plan);

/// Returns the planned report, filled in with the results in the store. What has no record stays
/// MISSING. p_machine: uses only cells that this machine measured; null: of any machine. References
/// and images may come from any machine.
Report collect_report(
		const Report &p_plan, const RecordStore &p_store, const ReportMachine *p_machine = nullptr);

/// Merges the folders of several shards into the folder p_out and returns the merged report. All
/// must have the same plan, else an Error names two folders that differ. If several folders have a
/// record of the same name, the first that did not fail is used. p_out may be one of p_folders.
Report merge_reports(
		const std::vector<std::filesystem::path> &p_folders, const std::filesystem::path &p_out);

} // namespace gnomon
