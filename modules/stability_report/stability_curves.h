#pragma once

#include "modules/error_report/report.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

enum class StabilityState {
	MISSING,
	OK,
	DOUBLED,  // the error is more than twice the centre's
	NONSENSE, // light where all is dark or shadow where all is lit, on more than the odd pixel
	REFUSED,  // nothing was drawn, and an error stated why
	FAILED,	  // not finite, outside 0..1, a validation message, or anything else that must not be
};
/// "missing", "ok", "doubled", "nonsense", "refused", "failed".
const char *get_state_name(StabilityState p_state);

/// Penumbra MAE where there is a penumbra to speak of, else over all receivers.
struct StabilityError {
	double mae = 0;
	bool is_of_penumbra = false;
};
/// Nothing where nothing was drawn or nothing receives.
std::optional<StabilityError> get_stability_error(const ReportCell &p_cell);

/// p_center: the same technique at the centre of the same sweep; null or without error: nothing
/// counts as doubled.
StabilityState judge_stability(
		const ReportCell &p_cell, const ReportReference &p_reference, const ReportCell *p_center);
/// The index of the centre's cell for that cell of a stability sweep; nothing: not planned.
std::optional<size_t> find_stability_center(const Report &p_report, const ReportCell &p_cell);

struct StabilityPoint {
	double value = 0;
	std::string label; // "1e-06", the case's name, or scene/light
	size_t cell = 0;   // index
	StabilityState state = StabilityState::MISSING;
	std::optional<StabilityError> error;
};
struct StabilityCurve {
	std::string technique;
	std::vector<StabilityPoint> points; // in the order of the sweep
	/// The first values that are not OK on the way from the centre to the curve's beginning and to
	/// its end.
	bool is_complete = true; // every point that was planned is measured
	std::optional<double> break_before;
	std::optional<double> break_after;
};
struct StabilityPlot {
	std::string sweep;
	std::string light_type;
	std::vector<StabilityCurve> curves;
};
std::vector<StabilityPlot> find_stability_plots(const Report &p_report);

} // namespace gnomon
