#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

inline constexpr const char *STABILITY_GROUP = "stability"; // also the id of StabilityPart

// Options of StabilityPart.
inline constexpr const char *STABILITY_OPTION = "--stability";
inline constexpr const char *SWEEPS_OPTION = "--sweeps"; // ids; none: all

/// The part of the report that measures techniques in extreme cases (doc/stability.md).
class StabilityPart : public ReportPart {
public:
	std::vector<ReportPartOption> list_options() const override;
	bool needs_own_scenes(const ReportOptions &p_options) const override;
	/// Adds one configuration per point of each requested sweep and type of light. The centre of a
	/// curve comes first. FULL: all values of each sweep, at 128 x 128 pixels (but not
	/// "resolution"). QUICK: two or three values, the centre among them (all points of "guards" and
	/// "scenes"), at 64 x 64 pixels (but not "resolution") and with one type of light ("light_size"
	/// and "scenes": with all).
	void plan(const ReportOptions &p_options, std::span<const ReportScene> p_scenes,
			const AddConfiguration &p_add) const override;
	/// Returns the reference of p_task and that of move_light(p_task), traced in double precision
	/// if float32 is too inaccurate. Images of more than 2^18 pixels get only the first, in
	/// float32. The number of samples is reduced, but not below 16, if a mask would need more than
	/// 2^30 rays.
	std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const override;
	/// Throws an Error for values that are not finite or outside 0..1, and for validation messages.
	/// An Error that the technique itself throws is stored as StabilityResult::refusal. Returns an
	/// image only for the centre and for StabilityState::NONSENSE.
	MaskImage run_cell(MaskSource &r_source, const MaskTask &p_task,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override;
	std::shared_ptr<const PartResult> read_result(
			const nlohmann::ordered_json &p_json) const override;
	std::optional<std::string> find_problem(const ReportCell &p_cell) const override;
	nlohmann::ordered_json to_json(const Report &p_report) const override;
	std::span<const PageFile> get_page_files() const override;
};

/// Returns the task with its light moved slightly, to measure the temporal error. A spot or
/// omni light moves sideways by a thousandth of its radius (by 1e-6 S if that is 0). A directional
/// light rotates by a thousandth of its angular radius (by 1e-6 rad if that is 0).
MaskTask move_light(const MaskTask &p_task);

} // namespace gnomon
