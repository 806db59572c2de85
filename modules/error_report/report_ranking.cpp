#include "modules/error_report/report_ranking.h"

#include "modules/masks/mask_timing.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <map>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

const char *const BEST_IN_EACH = "best in each";

/// Returns whether a cell has an error over penumbra pixels.
bool is_comparable(const ReportCell &p_cell) {
	return p_cell.is_ok() && p_cell.error && p_cell.error->all.penumbra.pixel_count > 0;
}

bool is_in_matrix(const Report &p_report, const ReportCell &p_cell) {
	return p_report.configurations[p_cell.configuration_index].is_matrix();
}

double get_penumbra_mae(const ReportCell &p_cell) {
	return p_cell.error->all.penumbra.mae;
}

/// Returns p_sum + p_value * p_weight; nullopt if either is unset.
std::optional<double> add_weighted(
		const std::optional<double> &p_sum, const std::optional<double> &p_value, double p_weight) {
	return p_sum && p_value ? std::optional(*p_sum + *p_value * p_weight) : std::nullopt;
}

RankingRow summarize(const Report &p_report, const std::string &p_technique,
		const std::string &p_setting, const std::vector<size_t> &p_cells) {
	RankingRow row;
	row.technique = p_technique;
	row.setting = p_setting;
	row.configuration_count = p_cells.size();
	row.penumbra_wrong = 0;
	row.receiver_wrong = 0;
	std::vector<double> costs_ms;
	std::vector<double> ratios;
	double whole_light_sum = 0;
	size_t whole_light_count = 0;
	for (const size_t index : p_cells) {
		const ReportCell &cell = p_report.cells[index];
		const MaskMetrics &all = cell.error->all;
		const double weight = 1.0 / double(p_cells.size());
		row.penumbra_mae += all.penumbra.mae * weight;
		row.penumbra_rmse += all.penumbra.rmse * weight;
		row.penumbra_p99 += all.penumbra.p99 * weight;
		row.penumbra_bias += all.penumbra.bias * weight;
		row.penumbra_wrong = add_weighted(row.penumbra_wrong, all.penumbra.wrong, weight);
		row.receiver_wrong = add_weighted(row.receiver_wrong, all.receiver.wrong, weight);
		row.umbra_over += all.umbra_over * weight;
		if (cell.error->whole_light.penumbra.pixel_count > 0) {
			whole_light_sum += cell.error->whole_light.penumbra.mae;
			++whole_light_count;
		}
		costs_ms.push_back(cell.time.cost_ms);
		if (const std::optional<double> ratio = p_report.compute_time_ratio(cell)) {
			ratios.push_back(*ratio);
		}
	}
	if (whole_light_count > 0) {
		row.whole_light_penumbra_mae = whole_light_sum / double(whole_light_count);
	}
	row.cost_ms = compute_percentile(costs_ms, 0.5);
	if (!ratios.empty()) {
		row.time_ratio = compute_percentile(ratios, 0.5);
	}
	return row;
}

/// Returns the rows in ascending order of penumbra_mae. p_lists: cell indices by technique and
/// setting.
std::vector<RankingRow> summarize_all(const Report &p_report,
		const std::map<std::pair<std::string, std::string>, std::vector<size_t>> &p_lists) {
	std::vector<RankingRow> rows;
	for (const auto &[key, cells] : p_lists) {
		rows.push_back(summarize(p_report, key.first, key.second, cells));
	}
	std::ranges::stable_sort(rows, {}, &RankingRow::penumbra_mae);
	return rows;
}

} // namespace

std::vector<RankingRow> rank_settings(const Report &p_report) {
	std::map<std::pair<std::string, std::string>, std::vector<size_t>> lists;
	for (size_t index = 0; index < p_report.cells.size(); ++index) {
		const ReportCell &cell = p_report.cells[index];
		if (is_comparable(cell) && is_in_matrix(p_report, cell)) {
			lists[{ cell.technique, cell.setting }].push_back(index);
		}
	}
	return summarize_all(p_report, lists);
}

std::vector<RankingRow> rank_best_settings(const Report &p_report) {
	std::map<std::pair<std::string, size_t>, size_t> best; // by technique and configuration
	for (size_t index = 0; index < p_report.cells.size(); ++index) {
		const ReportCell &cell = p_report.cells[index];
		if (!is_comparable(cell) || !is_in_matrix(p_report, cell)) {
			continue;
		}
		const auto [entry, is_new] =
				best.insert({ { cell.technique, cell.configuration_index }, index });
		if (!is_new && get_penumbra_mae(cell) < get_penumbra_mae(p_report.cells[entry->second])) {
			entry->second = index;
		}
	}
	std::map<std::pair<std::string, std::string>, std::vector<size_t>> lists;
	for (const auto &[key, index] : best) {
		lists[{ key.first, BEST_IN_EACH }].push_back(index);
	}
	return summarize_all(p_report, lists);
}

std::vector<size_t> find_pareto_front(const Report &p_report, size_t p_configuration) {
	std::vector<size_t> cells = p_report.find_cells(p_configuration);
	std::erase_if(cells, [&](size_t p_index) { return !is_comparable(p_report.cells[p_index]); });
	std::ranges::sort(cells, {}, [&](size_t p_index) {
		const ReportCell &cell = p_report.cells[p_index];
		return std::tuple(cell.time.cost_ms, get_penumbra_mae(cell), p_index);
	});
	std::vector<size_t> front;
	for (const size_t index : cells) {
		if (front.empty() ||
				get_penumbra_mae(p_report.cells[index]) <
						get_penumbra_mae(p_report.cells[front.back()])) {
			front.push_back(index);
		}
	}
	return front;
}

std::optional<size_t> find_within_budget(
		const Report &p_report, size_t p_configuration, double p_budget_ms) {
	std::optional<size_t> best;
	for (const size_t index : find_pareto_front(p_report, p_configuration)) {
		if (p_report.cells[index].time.cost_ms <= p_budget_ms) {
			best = index; // the front's error falls as its cost rises
		}
	}
	return best;
}

Json to_json(const std::vector<RankingRow> &p_rows) {
	Json json = Json::array();
	for (const RankingRow &row : p_rows) {
		json.push_back({ { "technique", row.technique }, { "setting", row.setting },
				{ "configuration_count", row.configuration_count },
				{ "penumbra_mae", row.penumbra_mae }, { "penumbra_rmse", row.penumbra_rmse },
				{ "penumbra_p99", row.penumbra_p99 }, { "penumbra_bias", row.penumbra_bias },
				{ "umbra_over", row.umbra_over }, { "cost_ms", row.cost_ms } });
		const std::pair<const char *, std::optional<double>> optional_values[] = {
			{ "penumbra_wrong", row.penumbra_wrong }, { "receiver_wrong", row.receiver_wrong },
			{ "whole_light_penumbra_mae", row.whole_light_penumbra_mae },
			{ "time_ratio", row.time_ratio }
		};
		for (const auto &[name, value] : optional_values) {
			if (value) {
				json.back()[name] = *value;
			}
		}
	}
	return json;
}

Json scaling_to_json(const Report &p_report) {
	Json plots = Json::array();
	const std::pair<const char *, const char *> groups[] = { { TRIANGLES_GROUP, "triangles" },
		{ LIGHT_SIZE_GROUP, "m" }, { LIGHTS_GROUP, "lights" }, { RESOLUTION_GROUP, "px" } };
	for (const auto &[name, unit] : groups) {
		Json series = Json::array();
		for (const ReportTechnique &technique : p_report.techniques) {
			std::multimap<double, size_t> cells; // by the configuration's value
			for (size_t index = 0; index < p_report.cells.size(); ++index) {
				const ReportCell &cell = p_report.cells[index];
				const ReportConfiguration &configuration =
						p_report.configurations[cell.configuration_index];
				if (configuration.group == name && cell.technique == technique.id && cell.is_ok()) {
					cells.insert({ configuration.value, index });
				}
			}
			Json points = Json::array();
			for (const auto &[value, index] : cells) {
				points.push_back({ { "value", value },
						{ "cost_ms", p_report.cells[index].time.cost_ms }, { "cell", index } });
			}
			if (!points.empty()) {
				series.push_back({ { "technique", technique.id }, { "points", points } });
			}
		}
		if (!series.empty()) {
			plots.push_back({ { "name", name }, { "unit", unit }, { "series", series } });
		}
	}
	return plots;
}

} // namespace gnomon
