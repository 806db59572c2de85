#pragma once

#include "modules/error_report/report.h"
#include "modules/stability_report/visibility_condition.h"

#include <optional>
#include <string>
#include <vector>

namespace gnomon {

/// Results of a cell of a stability sweep, next to its error.
class StabilityResult : public PartResult {
public:
	/// Temporal error over penumbra pixels (TemporalMetrics::penumbra_rmse) between two frames, see
	/// move_light. Unset if the image is too large to trace two references, or if the set of
	/// receiver pixels changes.
	std::optional<double> temporal_rmse;
	/// Fraction, 0..1, of all receivers: those that are fully lit or fully hidden in the reference
	/// (not is_penumbra) and whose error exceeds 0.5.
	double wrong_share = 0;
	std::vector<std::string> warnings; // logged while drawing
	/// The Error with which the technique refused to draw; then there are no other results. Empty
	/// if it did draw.
	std::string refusal;
	/// Set only if the error is more than twice that of the sweep's centre, or the mask is nonsense
	/// (see StabilityState).
	std::optional<VisibilityCondition> condition;

	nlohmann::ordered_json to_json() const override;
};

} // namespace gnomon
