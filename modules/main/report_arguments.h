#pragma once

#include "modules/error_report/run_report.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

/// The options of `gnomon report` and `report merge`, as CLI11 fills them in.
struct ReportArguments {
	std::string project;
	std::vector<std::string> scenes;
	std::vector<std::string> techniques;
	std::vector<std::string> sizes; // metres, or only "own"
	std::string settings = "all";
	uint32_t frame_count = 20;
	std::vector<std::string> skipped_scenes; // names or patterns, as of fnmatch
	std::vector<std::string> light_types;
	std::string size = "256x256";
	std::string scaling = "quick";
	std::string animation = "quick";
	std::optional<std::string> stability; // absent: "quick" if a module adds the sweeps
	ReportOptions options;				  // options that need no conversion
	std::string out;
	bool resumes = false;
	std::string against;
	std::optional<double> budget_ms;
	std::string shard;
	std::vector<std::string> merged;
	std::string merge_out;
};

/// Throws a UsageError for that option if a requested name is not known.
void check_known(const char *p_option, const std::vector<std::string> &p_requested,
		const std::vector<std::string> &p_known);
// Each function throws a UsageError that names the option, the value and what is allowed.
ReportRunOptions parse_run_options(const ReportArguments &p_arguments);
ReportOptions make_report_options(const ReportArguments &p_arguments, const std::string &p_project);

using NamedFiles = std::vector<std::pair<std::string, std::filesystem::path>>;

/// The scenes that a project or a single scene file names.
struct SelectedScenes {
	std::string project; // name of the project
	std::filesystem::path folder;
	NamedFiles scenes; // scenes of the report's matrix; at least one
	NamedFiles stability_scenes;
};
SelectedScenes select_scenes(const ReportArguments &p_arguments);

} // namespace gnomon
