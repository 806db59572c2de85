#include "modules/error_report/report_comparison.h"

#include "modules/core/text.h"
#include "modules/error_report/report_part.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

// Changes up to these margins are noise, see compare_reports.
const double ERROR_MARGIN = 0.0005;		   // rounding differences between devices are smaller
const double ERROR_MARGIN_FRACTION = 0.01; // of the old error
const double RATIO_MARGIN_FRACTION = 0.15; // repeated runs on one machine mostly differ by less
const double TIME_MARGIN_FRACTION = 0.3; // for times in ms, which also vary with the machine's load

/// Identifies a cell: configuration, technique, setting, width, height.
using Key = std::tuple<std::string, std::string, std::string, uint32_t, uint32_t>;

Key make_key(const Report &p_report, const ReportCell &p_cell) {
	const ReportConfiguration &configuration = p_report.configurations[p_cell.configuration_index];
	return { configuration.id, p_cell.technique, p_cell.setting, configuration.size_px.x,
		configuration.size_px.y };
}

/// Returns the 90th percentile minus the median, divided by the median, of the cell's GPU time; of
/// its wall time if less than half of cost_ms is GPU time.
double compute_spread(const ReportCell &p_cell) {
	const FrameCost &total = p_cell.time.total;
	const bool is_on_gpu = total.gpu_ms >= 0.5 * p_cell.time.cost_ms && total.gpu_ms > 0;
	const double median_ms = is_on_gpu ? total.gpu_ms : total.wall_ms;
	return median_ms > 0 ? (is_on_gpu ? total.gpu_ms_p90 : total.wall_ms_p90) / median_ms - 1.0 : 0;
}

/// Formats a value with 4 significant digits for the console; report.json has all digits.
std::string format_value(double p_value) {
	char digits[32];
	std::snprintf(digits, sizeof(digits), "%.4g", p_value);
	return digits;
}

class Comparer {
public:
	Comparer(const Report &p_old, const Report &p_new) : old_report(p_old), new_report(p_new) {}

	ReportComparison run() {
		std::map<Key, const ReportCell *> old_cells;
		for (const ReportCell &cell : old_report.cells) {
			old_cells[make_key(old_report, cell)] = &cell;
		}
		for (const ReportCell &cell : new_report.cells) {
			const auto found = old_cells.find(make_key(new_report, cell));
			if (found == old_cells.end()) {
				++comparison.only_new_count;
				continue;
			}
			compare(*found->second, cell);
			old_cells.erase(found);
		}
		comparison.only_old_count = old_cells.size();
		comparison.has_same_machine = old_report.machines == new_report.machines;
		std::stable_partition(comparison.differences.begin(), comparison.differences.end(),
				[](const ReportDifference &p_difference) { return p_difference.is_worse; });
		return std::move(comparison);
	}

private:
	void compare(const ReportCell &p_old, const ReportCell &p_new) {
		if (!p_old.is_ok() || !p_new.is_ok()) {
			const bool is_worse = p_old.is_ok() && p_new.status == ReportStatus::FAILED;
			const bool is_better = p_old.status == ReportStatus::FAILED && p_new.is_ok();
			if (is_worse || is_better) {
				add(p_new, "status", p_old.is_ok(), p_new.is_ok(), is_worse, p_new.message);
			}
			return;
		}
		++comparison.compared_count;
		compare_usability(p_old, p_new);
		if (p_old.error && p_new.error) {
			const MaskMetrics &before = p_old.error->all;
			const MaskMetrics &after = p_new.error->all;
			compare_errors(p_old, p_new, "penumbra error", before.penumbra, after.penumbra);
			compare_errors(p_old, p_new, "receiver error", before.receiver, after.receiver);
		}
		compare_times(p_old, p_new);
	}

	/// Adds a difference if a cell was usable before and is unusable now, or vice versa.
	void compare_usability(const ReportCell &p_old, const ReportCell &p_new) {
		const ReportPart *part = ReportPartRegistry::find_part(
				new_report.configurations[p_new.configuration_index].group);
		if (part == nullptr || !p_old.part_result || !p_new.part_result) {
			return;
		}
		const std::optional<std::string> before = part->find_problem(p_old);
		const std::optional<std::string> after = part->find_problem(p_new);
		if (before.has_value() != after.has_value()) {
			add(p_new, "status", !before, !after, after.has_value(), after.value_or(""));
		}
	}

	void compare_errors(const ReportCell &p_old, const ReportCell &p_new, const char *p_what,
			const ErrorMetrics &p_before, const ErrorMetrics &p_after) {
		double margin = ERROR_MARGIN + ERROR_MARGIN_FRACTION * p_before.mae;
		if (old_report.sample_count != new_report.sample_count) {
			margin +=
					old_report.configurations[p_old.configuration_index].reference.standard_error +
					new_report.configurations[p_new.configuration_index].reference.standard_error;
		}
		if (std::abs(p_after.mae - p_before.mae) > margin) {
			add(p_new, p_what, p_before.mae, p_after.mae, p_after.mae > p_before.mae);
		}
	}

	void compare_times(const ReportCell &p_old, const ReportCell &p_new) {
		const ReportCell *old_baseline = old_report.find_baseline(p_old);
		const ReportCell *new_baseline = new_report.find_baseline(p_new);
		const std::optional<double> old_ratio = old_report.compute_time_ratio(p_old);
		const std::optional<double> new_ratio = new_report.compute_time_ratio(p_new);
		double spread = compute_spread(p_old) + compute_spread(p_new);
		if (old_ratio && new_ratio && new_baseline != &p_new) {
			spread += compute_spread(*old_baseline) + compute_spread(*new_baseline);
			compare_times(p_new, "time ratio", *old_ratio, *new_ratio,
					std::max(RATIO_MARGIN_FRACTION, spread));
		} else if (old_report.machines[p_old.machine_index] ==
				new_report.machines[p_new.machine_index]) {
			compare_times(p_new, "time", p_old.time.cost_ms, p_new.time.cost_ms,
					std::max(TIME_MARGIN_FRACTION, spread));
		}
	}

	void compare_times(const ReportCell &p_new, const char *p_what, double p_before, double p_after,
			double p_margin_fraction) {
		if (p_before > 0 && std::abs(p_after / p_before - 1.0) > p_margin_fraction) {
			add(p_new, p_what, p_before, p_after, p_after > p_before);
		}
	}

	void add(const ReportCell &p_cell, const std::string &p_what, double p_old, double p_new,
			bool p_is_worse, const std::string &p_message = {}) {
		comparison.differences.push_back({ new_report.configurations[p_cell.configuration_index].id,
				p_cell.technique, p_cell.setting, p_what, p_old, p_new, p_message, p_is_worse });
	}

	const Report &old_report;
	const Report &new_report;
	ReportComparison comparison;
};

} // namespace

bool ReportComparison::has_regression() const {
	return std::any_of(
			differences.begin(), differences.end(), [](const ReportDifference &p_difference) {
				return p_difference.is_worse && !p_difference.is_of_time();
			});
}

ReportComparison compare_reports(const Report &p_old, const Report &p_new) {
	return Comparer(p_old, p_new).run();
}

Json to_json(const ReportComparison &p_comparison) {
	Json rows = Json::array();
	for (const ReportDifference &difference : p_comparison.differences) {
		rows.push_back({ { "configuration", difference.configuration },
				{ "technique", difference.technique }, { "setting", difference.setting },
				{ "what", difference.what }, { "old", difference.old_value },
				{ "new", difference.new_value },
				{ "change", difference.new_value - difference.old_value },
				{ "verdict", difference.is_worse ? "worse" : "better" },
				{ "message", difference.message } });
	}
	return { { "compared_count", p_comparison.compared_count },
		{ "only_old_count", p_comparison.only_old_count },
		{ "only_new_count", p_comparison.only_new_count },
		{ "has_same_machine", p_comparison.has_same_machine }, { "rows", rows } };
}

std::string to_text(const ReportComparison &p_comparison) {
	std::string lines = text("Against the old report: ", p_comparison.compared_count,
			" cells that both measured, ", p_comparison.only_old_count, " only in the old, ",
			p_comparison.only_new_count, " only in the new.\n");
	for (const ReportDifference &difference : p_comparison.differences) {
		// Only an unusable mask has no message.
		const std::string problem = difference.message.empty() ? "its mask is unusable now"
															   : "fails now: " + difference.message;
		lines += text(difference.is_worse ? "worse " : "better ", difference.what, ": ",
				difference.configuration, ", ", difference.technique, ", ", difference.setting,
				": ");
		lines += difference.what == "status"
				? (difference.is_worse ? problem : std::string("does not fail any more"))
				: text(format_value(difference.old_value), " -> ",
						  format_value(difference.new_value),
						  difference.what == "time ratio"	  ? " times the baseline"
								  : difference.what == "time" ? " ms"
															  : "");
		lines += "\n";
	}
	if (p_comparison.differences.empty()) {
		lines += "Nothing differs by more than the noise.\n";
	}
	return lines;
}

} // namespace gnomon
