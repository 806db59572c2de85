#pragma once

#include "modules/core/extension_registry.h"
#include "modules/error_report/mask_source.h"
#include "modules/error_report/report_plan.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// Interface for an additional part of the report, next to the matrix and the scaling curves, that
/// an optional module provides: animation and stability. Its configurations form one group
/// (ReportConfiguration::group), whose name is the part's id.
class ReportPart {
public:
	/// Adds a configuration to the plan, with the function that builds its task.
	using AddConfiguration = std::function<void(ReportConfiguration, ReportPlan::MakeTask)>;

	virtual ~ReportPart() = default;
	/// Returns the names that ReportOptions::sweeps may contain, in the order of the report.
	virtual std::vector<std::string> list_sweeps() const = 0;
	/// Called once per report: calls p_add for each configuration that the options request, in the
	/// order of measurement.
	virtual void plan(const ReportOptions &p_options, const AddConfiguration &p_add) const = 0;
	/// Called once per configuration, before its cells are measured. Returns the reference of the
	/// configuration, followed by other references that run_cell needs. p_sample_count: maximum
	/// number of rays per pixel.
	virtual std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const = 0;
	/// Draws the cell r_report.cells[p_cell] and sets its `error` and `stability`. p_references:
	/// the result of trace_references for its configuration. Returns the mask to store in the
	/// report, or an empty one to store none. Throws an Error if drawing fails or gives an invalid
	/// result.
	virtual MaskImage run_cell(MaskSource &r_source, const MaskTask &p_task,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const = 0;
	/// Returns true if a measured cell has an unusable mask, or if the technique refused to draw.
	virtual bool is_unusable(const ReportCell &p_cell) const = 0;
	/// Returns the value of the part's key in report.json: data derived from all its cells.
	virtual nlohmann::ordered_json to_json(const Report &p_report) const = 0;
};

/// A registered ReportPart.
struct ReportPartInfo {
	std::string id; // name of its group of configurations, and key in report.json
	std::shared_ptr<const ReportPart> part;
};

/// The report parts of this build. Modules add theirs at ModuleLevel::FEATURES.
class ReportPartRegistry : public ExtensionRegistry<ReportPartInfo> {
public:
	/// Returns the part with that id; null if there is none.
	static const ReportPart *find_part(std::string_view p_id) {
		const ReportPartInfo *info = find(p_id);
		return info != nullptr ? info->part.get() : nullptr;
	}
};

} // namespace gnomon
