#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

/// The part of the report that measures animated scenes. At several times of each scene's first
/// animation it measures the error of the mask, and the temporal error between that frame and the
/// one 1/30 s later (see TemporalMetrics).
class AnimationPart : public ReportPart {
public:
	std::vector<std::string> list_sweeps() const override { return {}; }
	/// Adds one configuration per animated scene, shadow-casting light and time.
	void plan(const ReportOptions &p_options, const AddConfiguration &p_add) const override;
	/// Returns two references: of p_task.scene and of p_task.next_scene.
	std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const override;
	/// Sets the error and the temporal error of the cell. Returns an empty image.
	MaskImage run_cell(MaskSource &r_source, const MaskTask &p_task,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override;
	bool is_unusable(const ReportCell & /*p_cell*/) const override { return false; }
	/// Returns one plot per scene and light, each with one series per technique.
	nlohmann::ordered_json to_json(const Report &p_report) const override;
};

} // namespace gnomon
