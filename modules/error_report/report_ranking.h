#pragma once

#include "modules/error_report/report.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// Summary of one technique with one setting over all configurations in which it was measured.
/// Errors are means, cost_ms and time_ratio are medians.
struct RankingRow {
	std::string technique;
	std::string setting; // "best in each" if chosen separately in each configuration
	size_t configuration_count = 0;
	double penumbra_mae = 0;
	double penumbra_rmse = 0;
	double penumbra_p99 = 0;
	double penumbra_bias = 0;
	/// Means of ErrorMetrics::wrong; unset if a cell has no such value (from an older report).
	std::optional<double> penumbra_wrong;
	std::optional<double> receiver_wrong;
	double umbra_over = 0; // see MaskMetrics
	/// Over the pixels of ReportError::whole_light; unset if there are none in the penumbra.
	std::optional<double> whole_light_penumbra_mae;
	double cost_ms = 0;
	std::optional<double> time_ratio; // see Report::compute_time_ratio; unset without a baseline
};

/// Returns one row per technique and setting over the configurations of the matrix, sorted by
/// ascending penumbra_mae. Cells without an error or without penumbra pixels are ignored.
std::vector<RankingRow> rank_settings(const Report &p_report);
/// Returns one row per technique, sorted in the same way. In each configuration the setting with
/// the lowest penumbra_mae is used.
std::vector<RankingRow> rank_best_settings(const Report &p_report);

/// Returns the Pareto front of a configuration as cell indices in ascending order of cost_ms: the
/// cells with a lower penumbra MAE than every cell that costs less. Of cells with equal cost it
/// contains at most one. Cells without an error or without penumbra pixels are ignored.
std::vector<size_t> find_pareto_front(const Report &p_report, size_t p_configuration);
/// Returns the cell with the lowest penumbra MAE among those with cost_ms <= p_budget_ms; nullopt
/// if there is none.
std::optional<size_t> find_within_budget(
		const Report &p_report, size_t p_configuration, double p_budget_ms);

// Return the values of "ranking" and "best_settings", and of "scaling", in report.json.
nlohmann::ordered_json to_json(const std::vector<RankingRow> &p_rows);
nlohmann::ordered_json scaling_to_json(const Report &p_report);

} // namespace gnomon
