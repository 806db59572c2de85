#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace gnomon {

// The forms of doc/report_format.md.

inline constexpr const char *REPORT_FORMAT = "gnomon_report";
inline constexpr int REPORT_VERSION = 2;

/// The whole report with what is computed from its cells: fronts, ratios, ranking, curves.
nlohmann::ordered_json to_json(const Report &p_report);
/// Reads report.json or plan.json; what is computed from the cells is not read. A file that is
/// missing, damaged, or of another format or version is an Error naming it.
Report load_report(const std::filesystem::path &p_path);

/// One row a cell under a row of names; RFC 4180 but for its lines, which
/// end as in Unix. Numbers that are absent are empty.
std::string to_csv(const Report &p_report);

/// As text for a file. Bytes that are no UTF-8, which file names may hold, are replaced.
std::string dump_json(const nlohmann::ordered_json &p_json);

/// What was measured of one cell, for its record.
nlohmann::ordered_json cell_result_to_json(
		const ReportCell &p_cell, const ReportMachine &p_machine);
/// Fills the cell from its record and adds the machine to the report when it is new there. A record
/// of another form is an Error, and leaves the cell as it is.
ReportMachine read_cell_machine(const nlohmann::ordered_json &p_json);
void read_cell_result(const nlohmann::ordered_json &p_json, Report &r_report, ReportCell &r_cell);
/// The same for the image of a scene.
nlohmann::ordered_json scene_image_result_to_json(const ReportSceneImage &p_image);
void read_scene_image_result(const nlohmann::ordered_json &p_json, ReportSceneImage &r_image);
/// The same for the reference of a configuration.
nlohmann::ordered_json reference_result_to_json(const ReportConfiguration &p_configuration);
void read_reference_result(
		const nlohmann::ordered_json &p_json, ReportConfiguration &r_configuration);

} // namespace gnomon
