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
	std::vector<std::string> sizes; // metres, or "own" alone
	std::string settings = "all";
	uint32_t frame_count = 20;
	std::vector<std::string> skipped_scenes; // names; * is any text
	std::vector<std::string> light_types;
	std::string size = "256x256";
	std::string scaling = "quick";
	std::string animation = "quick";
	std::optional<std::string> stability; // absent: "quick" where a module adds the sweeps
	ReportOptions options;				  // those that are taken as they are
	std::string out;
	bool resumes = false;
	std::string against;
	std::optional<double> budget_ms;
	std::string shard;
	std::vector<std::string> merged;
	std::string merge_out;
};

/// A UsageError of that option where something is requested that is not known.
void check_known(const char *p_option, const std::vector<std::string> &p_requested,
		const std::vector<std::string> &p_known);
// Each throws a UsageError that names the option, the value and what is allowed.
ReportRunOptions parse_run_options(const ReportArguments &p_arguments);
ReportOptions make_report_options(const ReportArguments &p_arguments, const std::string &p_project);

using NamedFiles = std::vector<std::pair<std::string, std::filesystem::path>>;

/// What a project or a single scene's file names.
struct SelectedScenes {
	std::string project; // its name
	std::filesystem::path folder;
	NamedFiles scenes; // of the matrix; at least one
	NamedFiles stability_scenes;
};
SelectedScenes select_scenes(const ReportArguments &p_arguments);

} // namespace gnomon
