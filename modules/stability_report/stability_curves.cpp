#include "modules/stability_report/stability_curves.h"

#include "modules/stability_report/stability_part.h"
#include "modules/stability_report/stability_result.h"
#include "modules/stability_report/stability_sweeps.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace gnomon {

using Json = nlohmann::ordered_json;

namespace {

const double MAX_ERROR_RATIO = 2.0; // of a point that does not break, to the centre's error
const uint64_t MIN_PENUMBRA_PIXEL_COUNT = 40; // the mean error of fewer pixels is unreliable
// Errors up to this are no break, however small the centre's error is: an 8-bit image does not show
// them.
const double MIN_BREAKING_MAE = 1.0 / 256;
// Maximum wrong_share that is no nonsense: hard shadows have edges that are off by a pixel.
const double MAX_WRONG_SHARE = 0.02;
const double NOISE_STANDARD_ERRORS = 2.0; // tolerated noise, in standard errors of the reference

bool is_stability(const ReportConfiguration &p_configuration) {
	return p_configuration.group == STABILITY_GROUP;
}

/// Returns whether two configurations are points of the same curve.
bool are_in_same_curve(
		const ReportConfiguration &p_configuration, const ReportConfiguration &p_other) {
	return is_stability(p_configuration) && is_stability(p_other) &&
			p_configuration.sweep == p_other.sweep &&
			p_configuration.light_type == p_other.light_type;
}

/// Returns the first value that breaks, searching from the centre in one direction (p_step: +1 or
/// -1); nullopt if none does.
std::optional<double> find_break(
		const std::vector<StabilityPoint> &p_points, double p_center, int p_step) {
	const auto center = std::find_if(p_points.begin(), p_points.end(),
			[&](const StabilityPoint &p_point) { return p_point.value == p_center; });
	if (center == p_points.end()) {
		return std::nullopt;
	}
	for (long index = center - p_points.begin(); index >= 0 && index < long(p_points.size());
			index += p_step) {
		const StabilityPoint &point = p_points[size_t(index)];
		if (point.state != StabilityState::OK && point.state != StabilityState::MISSING) {
			return point.value;
		}
	}
	return std::nullopt;
}

/// Returns the values of the sweep in the order of the curve. For the sweep over the project's
/// scenes they are taken from the report.
std::vector<double> find_values(const Report &p_report, const StabilitySweep &p_sweep) {
	if (!p_sweep.has_project_scenes) {
		return p_sweep.values;
	}
	std::set<double> values;
	for (const ReportConfiguration &at : p_report.configurations) {
		if (is_stability(at) && at.sweep == p_sweep.id) {
			values.insert(at.value);
		}
	}
	return { values.begin(), values.end() };
}

StabilityCurve make_curve(const Report &p_report, const std::string &p_technique,
		const StabilitySweep &p_sweep, const std::string &p_light_type) {
	StabilityCurve curve;
	curve.technique = p_technique;
	for (const double value : find_values(p_report, p_sweep)) {
		for (size_t index = 0; index < p_report.cells.size(); ++index) {
			const ReportCell &cell = p_report.cells[index];
			const ReportConfiguration &at = p_report.configurations[cell.configuration_index];
			if (cell.technique != p_technique || !is_stability(at) || at.sweep != p_sweep.id ||
					at.light_type != p_light_type || at.value != value) {
				continue;
			}
			const std::optional<size_t> center = find_stability_center(p_report, cell);
			curve.points.push_back({ value,
					p_sweep.has_project_scenes ? at.scene + "/" + at.light
											   : p_sweep.describe_value(value),
					index,
					classify_stability(
							cell, at.reference, center ? &p_report.cells[*center] : nullptr),
					get_stability_error(cell) });
		}
	}
	curve.is_complete = std::none_of(curve.points.begin(), curve.points.end(),
			[](const StabilityPoint &p_point) { return p_point.state == StabilityState::MISSING; });
	if (!p_sweep.has_cases()) { // separate cases have no order
		curve.break_before = find_break(curve.points, p_sweep.center, -1);
		curve.break_after = find_break(curve.points, p_sweep.center, 1);
	}
	return curve;
}

} // namespace

const char *get_state_name(StabilityState p_state) {
	static const char *const NAMES[] = { "missing", "ok", "doubled", "nonsense", "refused",
		"failed" };
	return NAMES[static_cast<int>(p_state)];
}

std::optional<StabilityError> get_stability_error(const ReportCell &p_cell) {
	if (!p_cell.is_ok() || !p_cell.error || p_cell.error->all.receiver.pixel_count == 0) {
		return std::nullopt;
	}
	const MaskMetrics &metrics = p_cell.error->all;
	const bool has_penumbra = metrics.penumbra.pixel_count >= MIN_PENUMBRA_PIXEL_COUNT;
	return StabilityError{ has_penumbra ? metrics.penumbra.mae : metrics.receiver.mae,
		has_penumbra };
}

StabilityState classify_stability(
		const ReportCell &p_cell, const ReportReference &p_reference, const ReportCell *p_center) {
	const StabilityResult *result = p_cell.find_result<StabilityResult>();
	if (p_cell.status != ReportStatus::OK || result == nullptr) {
		return p_cell.status == ReportStatus::FAILED ? StabilityState::FAILED
													 : StabilityState::MISSING;
	}
	if (!result->refusal.empty()) {
		return StabilityState::REFUSED;
	}
	if (result->wrong_share > MAX_WRONG_SHARE) {
		return StabilityState::NONSENSE;
	}
	const std::optional<StabilityError> error = get_stability_error(p_cell);
	const std::optional<StabilityError> center =
			p_center ? get_stability_error(*p_center) : std::nullopt;
	if (error && center) {
		// One of the two errors may be over all receivers and the other over the penumbra alone.
		// This is tolerated: an MAE over all receivers is usually the smaller one.
		const double allowed = std::max(MAX_ERROR_RATIO * center->mae, MIN_BREAKING_MAE) +
				NOISE_STANDARD_ERRORS * p_reference.standard_error;
		return error->mae > allowed ? StabilityState::DOUBLED : StabilityState::OK;
	}
	return StabilityState::OK;
}

std::optional<size_t> find_stability_center(const Report &p_report, const ReportCell &p_cell) {
	const ReportConfiguration &own = p_report.configurations[p_cell.configuration_index];
	const StabilitySweep *sweep = find_stability_sweep(own.sweep);
	if (sweep == nullptr) {
		return std::nullopt;
	}
	for (size_t index = 0; index < p_report.cells.size(); ++index) {
		const ReportCell &cell = p_report.cells[index];
		const ReportConfiguration &at = p_report.configurations[cell.configuration_index];
		if (cell.technique == p_cell.technique && are_in_same_curve(own, at) &&
				at.value == sweep->center) {
			return index;
		}
	}
	return std::nullopt;
}

std::vector<StabilityPlot> find_stability_plots(const Report &p_report) {
	std::vector<StabilityPlot> plots;
	for (const StabilitySweep &sweep : get_stability_sweeps()) {
		for (const LightType type : sweep.types) {
			StabilityPlot plot = { sweep.id, get_light_type_name(type), {} };
			for (const ReportTechnique &technique : p_report.techniques) {
				StabilityCurve curve = make_curve(p_report, technique.id, sweep, plot.light_type);
				if (!curve.points.empty()) {
					plot.curves.push_back(std::move(curve));
				}
			}
			if (!plot.curves.empty()) {
				plots.push_back(std::move(plot));
			}
		}
	}
	return plots;
}

Json StabilityPart::to_json(const Report &p_report) const {
	Json json = Json::array();
	for (const StabilityPlot &plot : find_stability_plots(p_report)) {
		const StabilitySweep &sweep = *find_stability_sweep(plot.sweep);
		Json series = Json::array();
		for (const StabilityCurve &curve : plot.curves) {
			Json points = Json::array();
			for (const StabilityPoint &point : curve.points) {
				points.push_back({ { "value", point.value }, { "label", point.label },
						{ "cell", point.cell }, { "state", get_state_name(point.state) } });
				if (point.error) {
					points.back()["mae"] = point.error->mae;
					points.back()["is_of_penumbra"] = point.error->is_of_penumbra;
				}
			}
			series.push_back({ { "technique", curve.technique },
					{ "is_complete", curve.is_complete }, { "points", points } });
			if (curve.break_before) {
				series.back()["break_before"] = sweep.describe_value(*curve.break_before);
			}
			if (curve.break_after) {
				series.back()["break_after"] = sweep.describe_value(*curve.break_after);
			}
		}
		json.push_back({ { "sweep", plot.sweep }, { "quantity", sweep.quantity },
				{ "light_type", plot.light_type },
				{ "center", sweep.has_project_scenes ? "" : sweep.describe_value(sweep.center) },
				{ "has_cases", sweep.has_cases() }, { "series", series } });
	}
	return json;
}

} // namespace gnomon
