#pragma once

#include "modules/error_report/record_store.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gnomon {

/// The page of a report: one HTML file with its plotting library, its data and its images inside,
/// which loads nothing. p_report: report.json; images are those that it names, from the store.
std::string build_report_page(const nlohmann::ordered_json &p_report, const RecordStore &p_store);

} // namespace gnomon
