#pragma once

#include "modules/error_report/record_store.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gnomon {

/// The page of a report: one self-contained HTML file with its plotting library, data and images.
/// p_report: report.json; p_store holds the images that it names.
std::string build_report_page(const nlohmann::ordered_json &p_report, const RecordStore &p_store);

} // namespace gnomon
