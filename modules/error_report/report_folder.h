#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

// Where in a report's folder its plan and its records are.
std::filesystem::path get_plan_path(const std::filesystem::path &p_folder);
std::filesystem::path get_record_folder(const std::filesystem::path &p_folder);
/// Names of all records that the plan needs.
std::vector<std::string> list_records(const Report &p_plan);

void save_plan(const std::filesystem::path &p_folder, const Report &p_plan);
/// Throws an Error where the folder holds records of another plan: going on would mix them. A
/// folder without a plan is new, and right.
void check_resumable(const std::filesystem::path &p_folder, const Report &p_plan);

/// The report of a plan with what a store holds of it; the rest stays missing. p_machine: what
/// others measured stays missing too; null = everybody's.
Report collect_report(
		const Report &p_plan, const RecordStore &p_store, const ReportMachine *p_machine = nullptr);

/// Puts the records of several stores, parts of one plan, into one; of one that several hold, the
/// first that did not fail. The folders are those of reports, with plan.json and cells. Folders
/// whose plans differ are an Error naming two of them.
Report merge_reports(
		const std::vector<std::filesystem::path> &p_folders, const std::filesystem::path &p_out);

} // namespace gnomon
