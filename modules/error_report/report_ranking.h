#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// One technique with one setting over all the configurations in which it was measured. Errors are
/// means, times medians.
struct RankingRow {
	std::string technique;
	std::string setting; // "best in each" where it is chosen separately in each configuration
	size_t configuration_count = 0;
	double penumbra_mae = 0;
	double penumbra_rmse = 0;
	double penumbra_p99 = 0;
	double penumbra_bias = 0;
	/// ErrorMetrics::wrong; absent when a cell comes from a report without it.
	std::optional<double> penumbra_wrong;
	std::optional<double> receiver_wrong;
	double umbra_over = 0;
	std::optional<double> whole_light_penumbra_mae; // absent when there are no such pixels
	double cost_ms = 0;
	std::optional<double> time_ratio;
};

/// Settings, sorted by ascending mean error over the configurations of the matrix.
std::vector<RankingRow> rank_settings(const Report &p_report);
/// Techniques, sorted in the same way, each with the setting of least error per configuration.
std::vector<RankingRow> rank_best_settings(const Report &p_report);

/// The Pareto front of a configuration: cells for which no other is both cheaper and closer to the
/// reference, by ascending cost. Cells without error or time are not on it.
std::vector<size_t> find_pareto_front(const Report &p_report, size_t p_configuration);
/// The cell of least error whose cost is within the budget; none when there is no such cell.
std::optional<size_t> find_within_budget(
		const Report &p_report, size_t p_configuration, double p_budget_ms);

nlohmann::ordered_json to_json(const std::vector<RankingRow> &p_rows);
/// One plot for each group of the scaling curves that was measured, points by rising value.
nlohmann::ordered_json scaling_to_json(const Report &p_report);

} // namespace gnomon
