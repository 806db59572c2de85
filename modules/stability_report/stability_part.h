#pragma once

#include "modules/error_report/report_part.h"

namespace gnomon {

/// The part of the report that measures techniques in extreme cases (doc/stability.md).
class StabilityPart : public ReportPart {
public:
	std::vector<std::string> list_sweeps() const override;
	/// Adds one configuration per point of each requested sweep and type of light. The centre of a
	/// curve comes first. ReportExtent::QUICK plans fewer points and types.
	void plan(const ReportOptions &p_options, const AddConfiguration &p_add) const override;
	/// Returns the reference of p_task and that of move_light(p_task), traced in double precision
	/// if float32 is too inaccurate. Images of more than 2^18 pixels get only the first, in
	/// float32. The number of samples is reduced, but not below 16, if a mask would need more than
	/// 2^30 rays.
	std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const override;
	/// Throws an Error for values that are not finite or outside 0..1, and for validation messages.
	/// An Error that the technique itself throws is stored as ReportStability::refusal. Returns an
	/// image only for the centre and for StabilityState::NONSENSE.
	MaskImage run_cell(MaskSource &r_source, const MaskTask &p_task,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const override;
	bool is_unusable(const ReportCell &p_cell) const override;
	nlohmann::ordered_json to_json(const Report &p_report) const override;
};

/// Returns the task with its light moved slightly, to measure the temporal error. A spot or
/// omni light moves sideways by a thousandth of its radius (by 1e-6 S if that is 0). A directional
/// light rotates by a thousandth of its angular radius (by 1e-6 rad if that is 0).
MaskTask move_light(const MaskTask &p_task);

} // namespace gnomon
