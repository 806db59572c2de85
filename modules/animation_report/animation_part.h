#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

/// The report's part that plays each scene's first animation: at some of its times the error, and
/// the error of change from there to a frame later (TemporalMetrics).
class AnimationPart : public ReportPart {
public:
	std::vector<std::string> list_sweeps() const override { return {}; }
	/// Each time of each light that casts shadows of each animated scene.
	void plan(const ReportOptions &p_options, const Add &p_add) const override;
	/// Of the question's scene and of its next_scene.
	std::vector<TracedReference> trace_references(MaskSource &r_source,
			const MaskQuestion &p_question, uint32_t p_sample_count) const override;
	/// Keeps no image.
	MaskImage run_cell(MaskSource &r_source, const MaskQuestion &p_question,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override;
	bool is_unusable(const ReportCell & /*p_cell*/) const override { return false; }
	/// A curve for each scene, light and technique.
	nlohmann::ordered_json to_json(const Report &p_report) const override;
};

} // namespace gnomon
