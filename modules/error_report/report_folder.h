#pragma once

#include "modules/error_report/record_store.h"
#include "modules/error_report/report.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

// Paths of the plan and the records in a report's folder.
std::filesystem::path get_plan_path(const std::filesystem::path &p_folder);
std::filesystem::path get_record_folder(const std::filesystem::path &p_folder);
/// Names of all records that the plan needs.
std::vector<std::string> list_records(const Report &p_plan);

void save_plan(const std::filesystem::path &p_folder, const Report &p_plan);
/// Throws an Error when the folder holds records of another plan, which must not be mixed. A folder
/// without a plan is new and valid.
void check_resumable(const std::filesystem::path &p_folder, const Report &p_plan);

/// The report of a plan with the records that the store holds; the others stay missing. p_machine:
/// take only cells that this machine measured; null = those of all machines. References and
/// images are taken from any machine.
Report collect_report(
		const Report &p_plan, const RecordStore &p_store, const ReportMachine *p_machine = nullptr);

/// Merges the records of several report folders (plan.json and cells), shards of one plan, into one
/// folder. Of records that several hold, the first that did not fail is taken. Throws an Error that
/// names two folders whose plans differ.
Report merge_reports(
		const std::vector<std::filesystem::path> &p_folders, const std::filesystem::path &p_out);

} // namespace gnomon
