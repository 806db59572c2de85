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

/// A part of the report in addition to its matrix and its scaling curves, of a module that a build
/// may lack. Its configurations form one group (ReportConfiguration::group), whose name is the
/// part's id.
class ReportPart {
public:
	using Add = std::function<void(ReportConfiguration, ReportPlan::MakeQuestion)>;

	virtual ~ReportPart() = default;
	/// What ReportOptions::sweeps may name, in the order of the report.
	virtual std::vector<std::string> list_sweeps() const = 0;
	/// Called once a plan: calls p_add for each configuration that the options request, in the
	/// order in which they are measured.
	virtual void plan(const ReportOptions &p_options, const Add &p_add) const = 0;
	/// Called once a configuration, before its cells: its reference, and after that whatever else
	/// of this kind its cells need. p_sample_count: of the report, at most as many are taken.
	virtual std::vector<TracedReference> trace_references(MaskSource &r_source,
			const MaskQuestion &p_question, uint32_t p_sample_count) const = 0;
	/// Draws a cell and fills its error and its own results. p_references: of its configuration.
	/// Returns the image that is worth keeping, else an empty one. What must not be is an Error.
	virtual MaskImage run_cell(MaskSource &r_source, const MaskQuestion &p_question,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const = 0;
	/// True of a measured cell whose mask is nonsense, or that refused to draw one.
	virtual bool is_unusable(const ReportCell &p_cell) const = 0;
	/// What report.json holds of the part as a whole, under its id.
	virtual nlohmann::ordered_json to_json(const Report &p_report) const = 0;
};

struct ReportPartInfo {
	std::string id; // its group of configurations, and its key in report.json
	std::shared_ptr<const ReportPart> part;
};

/// The parts of this build. Modules add theirs at ModuleLevel::FEATURES.
class ReportPartRegistry : public ExtensionRegistry<ReportPartInfo> {
public:
	/// Null: there is none of that id.
	static const ReportPart *find_part(std::string_view p_id) {
		const ReportPartInfo *info = find(p_id);
		return info != nullptr ? info->part.get() : nullptr;
	}
};

} // namespace gnomon
