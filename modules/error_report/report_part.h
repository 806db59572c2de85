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

/// A part of the report besides its matrix and its scaling curves, provided by an optional module.
/// Its configurations form one group (ReportConfiguration::group), named after the part's id.
class ReportPart {
public:
	using Add = std::function<void(ReportConfiguration, ReportPlan::MakeQuestion)>;

	virtual ~ReportPart() = default;
	/// Names that ReportOptions::sweeps may contain, in the order of the report.
	virtual std::vector<std::string> list_sweeps() const = 0;
	/// Called once a plan: calls p_add for each configuration that the options request, in the
	/// order in which they are measured.
	virtual void plan(const ReportOptions &p_options, const Add &p_add) const = 0;
	/// Called once per configuration, before its cells: returns its reference first, then other
	/// references that its cells need. p_sample_count: maximum number of samples.
	virtual std::vector<TracedReference> trace_references(MaskSource &r_source,
			const MaskQuestion &p_question, uint32_t p_sample_count) const = 0;
	/// Draws a cell and fills in its error and its own results. p_references: those of its
	/// configuration. Returns the image to keep, or an empty one. Throws an Error when
	/// drawing fails or gives an invalid result.
	virtual MaskImage run_cell(MaskSource &r_source, const MaskQuestion &p_question,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const = 0;
	/// True for a measured cell whose mask is unusable, or that refused to draw one.
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
