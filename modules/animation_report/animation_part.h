#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

inline constexpr const char *ANIMATION_GROUP = "animation"; // also the id of AnimationPart
inline constexpr const char *CHANGE_OPTION = "--change";	// of AnimationPart

/// Results of a cell of an animation, next to its error.
class AnimationResult : public PartResult {
public:
	/// Temporal error over penumbra pixels (TemporalMetrics::penumbra_rmse) while the scene
	/// advances by 1/30 s.
	double temporal_rmse = 0;
	std::vector<std::string> warnings; // logged while drawing

	nlohmann::ordered_json to_json() const override;
};

/// The part of the report that measures animated scenes. At several times of each scene's first
/// animation it measures the error of the mask, and the temporal error between that frame and the
/// one 1/30 s later (see TemporalMetrics).
class AnimationPart : public ReportPart {
public:
	std::vector<ReportPartOption> list_options() const override;
	/// Adds one configuration per scene with an animation, shadow-casting light and time. QUICK: 4
	/// times, FULL: 16.
	void plan(const ReportOptions &p_options, std::span<const ReportScene> p_scenes,
			const AddConfiguration &p_add) const override;
	/// Returns two references: of p_task.scene and of p_task.next_scene.
	std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const override;
	/// Sets the error and the temporal error of the cell. Returns an empty image.
	MaskImage run_cell(MaskSource &r_source, const MaskTask &p_task,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override;
	std::shared_ptr<const PartResult> read_result(
			const nlohmann::ordered_json &p_json) const override;
	/// Returns one plot per scene and light, each with one series per technique.
	nlohmann::ordered_json to_json(const Report &p_report) const override;
	std::span<const PageFile> get_page_files() const override;
};

} // namespace gnomon
