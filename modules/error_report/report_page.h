#pragma once

#include "modules/error_report/record_store.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace gnomon {

/// Returns the HTML page of a report: one self-contained file with the plotting library, the data
/// and the images. p_report: the content of report.json. p_store: contains the images that it
/// names.
std::string build_report_page(const nlohmann::ordered_json &p_report, const RecordStore &p_store);

} // namespace gnomon
