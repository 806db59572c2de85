#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

/// The report's part that takes techniques into stiff and extreme cases (doc/stability.md).
class StabilityPart : public ReportPart {
public:
	std::vector<std::string> list_sweeps() const override;
	/// Each point of the sweeps that the options request, the centre of a curve before its other
	/// points.
	void plan(const ReportOptions &p_options, const Add &p_add) const override;
	/// The question's own reference, and that of move_light; images too large to trace twice have
	/// only the first. Fewer samples are taken where an image is so large that it would take
	/// minutes.
	std::vector<TracedReference> trace_references(MaskSource &r_source,
			const MaskQuestion &p_question, uint32_t p_sample_count) const override;
	/// Values that are not finite or outside 0..1 and validation messages are an Error; a
	/// technique's own Error is a refusal. Worth keeping are images of nonsense and of the
	/// centre.
	MaskImage run_cell(MaskSource &r_source, const MaskQuestion &p_question,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override;
	bool is_unusable(const ReportCell &p_cell) const override;
	nlohmann::ordered_json to_json(const Report &p_report) const override;
};

/// The same question with the light a thousandth of its radius to the side (directional: turned by
/// a thousandth of its half angle; without a size: of S), for the error of change.
MaskQuestion move_light(const MaskQuestion &p_question);

} // namespace gnomon
