#pragma once

#include "modules/core/extension_registry.h"
#include "modules/error_report/mask_source.h"
#include "modules/error_report/page_files.h"
#include "modules/error_report/report_plan.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gnomon {

/// An option that a report part adds to the command `gnomon report`.
struct ReportPartOption {
	std::string name; // "--extent"; also listed by get_report_options() of the module's config.py
	std::string help;
	std::vector<std::string> values;		 // allowed ones
	std::vector<std::string> default_values; // without the option
	bool is_list = false;					 // takes any number of values, separated by commas
};
/// Returns an option whose values are EXTENT_NAMES, "quick" by default.
inline ReportPartOption make_extent_option(std::string p_name, std::string p_help) {
	return { std::move(p_name), std::move(p_help),
		{ std::begin(EXTENT_NAMES), std::end(EXTENT_NAMES) }, { "quick" } };
}

/// Interface for an additional part of the report, next to the matrix and the scaling curves, that
/// an optional module provides. Its configurations form one group (ReportConfiguration::group),
/// whose name is the part's id.
class ReportPart {
public:
	/// Adds a configuration to the plan, with the function that builds its task.
	using AddConfiguration = std::function<void(ReportConfiguration, ReportPlan::MakeTask)>;

	virtual ~ReportPart() = default;
	/// Returns the options of the part, in the order of --help. Their values are in
	/// ReportOptions::part_options.
	virtual std::vector<ReportPartOption> list_options() const { return {}; }
	/// Returns whether plan() uses ReportOptions::part_scenes, which are then loaded. The project
	/// lists them in the key "<id>_scenes" (Project::part_scenes).
	virtual bool needs_own_scenes(const ReportOptions & /*p_options*/) const { return false; }
	/// Called once per report: calls p_add for each configuration that the options request, in the
	/// order of measurement. p_scenes: those of the matrix.
	virtual void plan(const ReportOptions &p_options, std::span<const ReportScene> p_scenes,
			const AddConfiguration &p_add) const = 0;
	/// Called once per configuration, before its cells are measured. Returns the reference of the
	/// configuration, followed by other references that run_cell needs. p_sample_count: maximum
	/// number of rays per pixel.
	virtual std::vector<TracedReference> trace_references(
			MaskSource &r_source, const MaskTask &p_task, uint32_t p_sample_count) const = 0;
	/// Draws the cell r_report.cells[p_cell] and sets its `error` and `part_result`. p_references:
	/// the result of trace_references for its configuration. Returns the mask to store in the
	/// report, or an empty one to store none. Throws an Error if drawing fails or gives an invalid
	/// result.
	virtual MaskImage run_cell(MaskSource &r_source, const MaskTask &p_task,
			std::span<const TracedReference> p_references, Report &r_report,
			size_t p_cell) const = 0;
	/// Reads what PartResult::to_json of this or an earlier version returned. Throws an Error or a
	/// Json::exception if it has another form.
	virtual std::shared_ptr<const PartResult> read_result(
			const nlohmann::ordered_json &p_json) const = 0;
	/// Returns why a cell that was measured without a failure has no usable result: the message
	/// with which the technique refused to draw, or an empty text if its mask is unusable. nullopt
	/// if the result is usable.
	virtual std::optional<std::string> find_problem(const ReportCell & /*p_cell*/) const {
		return std::nullopt;
	}
	/// Returns the value of the part's key in report.json: data derived from all its cells.
	virtual nlohmann::ordered_json to_json(const Report &p_report) const = 0;
	/// Returns files that are joined with those of the page. A script adds the function that makes
	/// the part's section to `report.parts` (page/basics.js).
	virtual std::span<const PageFile> get_page_files() const { return {}; }
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
