#pragma once

#include "modules/error_report/report.h"

#include <string>

namespace gnomon {

/// One row a cell under a row of names; RFC 4180 but for its lines, which
/// end as in Unix. Numbers that are absent are empty.
std::string to_csv(const Report &p_report);

} // namespace gnomon
