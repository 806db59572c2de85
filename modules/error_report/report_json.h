#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace gnomon {

// Reading and writing of the formats in doc/report_format.md.

inline constexpr const char *REPORT_FORMAT = "gnomon_report";
inline constexpr int REPORT_VERSION = 2;

/// The whole report, with the values derived from its cells: Pareto fronts, ratios, ranking,
/// curves.
nlohmann::ordered_json to_json(const Report &p_report);
/// Reads report.json or plan.json, without the derived values. Throws an Error that names the file
/// when it is missing, damaged, of another format, or not of version 1..REPORT_VERSION.
Report load_report(const std::filesystem::path &p_path);

/// A header row and one row per cell; RFC 4180, but with LF line ends. Absent numbers are empty.
std::string to_csv(const Report &p_report);

/// The JSON text for a file. Bytes that are not UTF-8, which file names may contain, are replaced.
std::string dump_json(const nlohmann::ordered_json &p_json);

/// The results of one cell, for its record.
nlohmann::ordered_json cell_result_to_json(
		const ReportCell &p_cell, const ReportMachine &p_machine);
/// The machine that measured a record; read_cell_result fills the cell from its record, and adds
/// the machine to the report when it is new. Throws an Error and leaves the cell unchanged for a
/// record of another format.
ReportMachine read_cell_machine(const nlohmann::ordered_json &p_json);
void read_cell_result(const nlohmann::ordered_json &p_json, Report &r_report, ReportCell &r_cell);
/// The same for the image of a scene, without a machine.
nlohmann::ordered_json scene_image_result_to_json(const ReportSceneImage &p_image);
void read_scene_image_result(const nlohmann::ordered_json &p_json, ReportSceneImage &r_image);
/// The same for the reference of a configuration, without a machine.
nlohmann::ordered_json reference_result_to_json(const ReportConfiguration &p_configuration);
void read_reference_result(
		const nlohmann::ordered_json &p_json, ReportConfiguration &r_configuration);

} // namespace gnomon
