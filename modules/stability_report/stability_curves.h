#pragma once

#include "modules/error_report/report.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// How well a technique copes with a point of a sweep. "Centre" is the reference point of the
/// sweep, StabilitySweep::center.
enum class StabilityState {
	MISSING, // not measured
	OK,
	/// The error exceeds both twice that of the centre and 1/256, each plus two standard errors of
	/// the reference.
	DOUBLED,
	NONSENSE, // more than 2 % of the receivers are wrong, see StabilityResult::wrong_share
	REFUSED,  // the technique drew nothing and threw an Error instead
	FAILED,	  // values not finite or outside 0..1, a validation message, or another failure
};
/// Returns "missing", "ok", "doubled", "nonsense", "refused", "failed".
const char *get_state_name(StabilityState p_state);

/// Mean absolute error over penumbra pixels; over all receivers if fewer than 40 pixels are
/// penumbra.
struct StabilityError {
	double mae = 0;
	bool is_of_penumbra = false;
};
/// Returns nullopt if nothing was drawn or the mask has no receivers.
std::optional<StabilityError> get_stability_error(const ReportCell &p_cell);

/// Classifies a cell of a stability sweep. p_reference: that of the cell's configuration. p_center:
/// the cell of the same technique at the centre of the sweep; if it is null or has no error, the
/// result is never DOUBLED.
StabilityState classify_stability(
		const ReportCell &p_cell, const ReportReference &p_reference, const ReportCell *p_center);
/// Returns the index of the cell of the same technique at the centre of p_cell's curve; nullopt if
/// the centre is not part of the report.
std::optional<size_t> find_stability_center(const Report &p_report, const ReportCell &p_cell);

/// A measured point of a curve.
struct StabilityPoint {
	double value = 0;  // see StabilitySweep::values
	std::string label; // the value as text ("1e-06"), the name of the case, or scene/light
	size_t cell = 0;   // index in Report::cells
	StabilityState state = StabilityState::MISSING;
	std::optional<StabilityError> error;
};
/// The points of one technique in a sweep with one type of light.
struct StabilityCurve {
	std::string technique;				// id
	std::vector<StabilityPoint> points; // in the order of StabilitySweep::values
	bool is_complete = true;			// no planned point is MISSING
	/// The first values that are neither OK nor MISSING, from the centre (inclusive) towards the
	/// beginning of the curve, and towards its end. Unset if there is none, if the centre is not in
	/// the report, or if the points are separate cases (StabilitySweep::has_cases).
	std::optional<double> break_before;
	std::optional<double> break_after;
};
/// The curves of one sweep with one type of light.
struct StabilityPlot {
	std::string sweep;					// id
	std::string light_type;				// "spot", "omni", "directional"
	std::vector<StabilityCurve> curves; // one per technique
};
/// Returns all curves of a report, in the order of get_stability_sweeps().
std::vector<StabilityPlot> find_stability_plots(const Report &p_report);

} // namespace gnomon
