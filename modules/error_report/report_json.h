#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace gnomon {

// Reads and writes the files that doc/report_format.md describes.

inline constexpr const char *REPORT_FORMAT = "gnomon_report";
inline constexpr int REPORT_VERSION = 2;

/// Returns the content of report.json, including values derived from the cells: Pareto fronts, time
/// ratios, rankings, scaling curves, and the data of each registered ReportPart.
nlohmann::ordered_json to_json(const Report &p_report);
/// Reads report.json or plan.json; derived values are ignored. Throws an Error that names the file
/// if it is missing or damaged, has another format, or a version outside 1..REPORT_VERSION.
Report load_report(const std::filesystem::path &p_path);

/// Returns the content of report.csv: a header row and one row per cell. RFC 4180, but with LF line
/// ends. Fields of absent values are empty.
std::string to_csv(const Report &p_report);

/// Serializes JSON as the text of a file, indented. Bytes that are not UTF-8, which file names may
/// contain, are replaced.
std::string dump_json(const nlohmann::ordered_json &p_json);

/// Returns the content of the record of a measured cell.
nlohmann::ordered_json cell_result_to_json(
		const ReportCell &p_cell, const ReportMachine &p_machine);
/// Returns the machine that measured a cell, from the content of its record. Throws an Error if the
/// content has another format.
ReportMachine read_cell_machine(const nlohmann::ordered_json &p_json);
/// Sets the results of a cell from the content of its record, and adds the record's machine to the
/// report if it is new. Throws an Error and leaves the cell unchanged if the content has another
/// format.
void read_cell_result(const nlohmann::ordered_json &p_json, Report &r_report, ReportCell &r_cell);
// The same for the image of a scene; its record has no machine.
nlohmann::ordered_json scene_image_result_to_json(const ReportSceneImage &p_image);
void read_scene_image_result(const nlohmann::ordered_json &p_json, ReportSceneImage &r_image);
// The same for the reference of a configuration; its record has no machine.
nlohmann::ordered_json reference_result_to_json(const ReportConfiguration &p_configuration);
void read_reference_result(
		const nlohmann::ordered_json &p_json, ReportConfiguration &r_configuration);

} // namespace gnomon
