#pragma once

#include "modules/error_report/mask_source.h"

#include <span>
#include <vector>

namespace gnomon {

/// The same question with the light a thousandth of its radius to the side (directional: turned by
/// a thousandth of its half angle; without a size: of S), for the error of change.
MaskQuestion move_light(const MaskQuestion &p_question);

/// The question's own truth, and that of move_light; images too large to trace twice have only the
/// first. p_sample_count: of the report; fewer where an image is so large that it would take
/// minutes.
std::vector<TracedTruth> trace_stability_truths(
		MaskSource &r_source, const MaskQuestion &p_question, uint32_t p_sample_count);

/// Draws one point of a sweep and fills the cell's error and stability. Values that are not finite
/// or outside 0..1 and validation messages are an Error; a technique's own Error is a refusal.
/// p_center: see judge_stability; may be the cell itself. Returns
/// the picture where it is worth keeping, nonsense and the centre, else an empty one.
MaskImage run_stability_cell(MaskSource &r_source, const MaskQuestion &p_question,
		std::span<const TracedTruth> p_truths, const ReportTruth &p_reported,
		const ReportCell *p_center, ReportCell &r_cell);

} // namespace gnomon
