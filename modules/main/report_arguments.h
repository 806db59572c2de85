#pragma once

#include "modules/error_report/run_report.h"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace gnomon {

/// The arguments of `gnomon report` and `gnomon report merge`, as CLI11 stores them. Each is the
/// option of the same name unless a comment says otherwise.
struct ReportArguments {
	std::filesystem::path project;			 // or a scene file
	std::vector<std::string> scenes;		 // names; empty: all
	std::vector<std::string> techniques;	 // ids; empty: all but the reference and examples
	std::vector<std::string> sizes;			 // metres, or only "own"; empty: the default sizes
	std::string settings = "all";			 // or "default"
	uint32_t frame_count = 20;				 // --frames: maximum per cell
	std::vector<std::string> skipped_scenes; // --skip: names; * is any text
	std::vector<std::string> light_types;	 // "spot", "omni", "directional", or only "own"
	std::string size = "256x256";			 // of the masks, pixels
	std::string scaling = "quick";			 // or "none", "full"
	ReportOptions options; // receives options that need no conversion, and those of report parts
	std::filesystem::path out;
	bool resumes = false;					   // --resume
	std::filesystem::path against;			   // an older report.json; empty: none
	std::optional<double> budget_ms;		   // --budget
	std::string shard;						   // "I/N"; empty: the whole report
	std::vector<std::filesystem::path> merged; // folders of the shards to merge
	std::filesystem::path merge_out;		   // --out of `report merge`
};

/// Throws a UsageError that names the option p_option and the valid names if a requested name is
/// not one of p_valid_names.
void check_names(const char *p_option, const std::vector<std::string> &p_requested,
		const std::vector<std::string> &p_valid_names);
// Convert the arguments. Both throw a UsageError that names the option, the value and the allowed
// values.
ReportRunOptions parse_run_options(const ReportArguments &p_arguments);
ReportOptions make_report_options(const ReportArguments &p_arguments, const std::string &p_project);

/// Scene files by name: the file name without extension.
using NamedFiles = std::vector<std::pair<std::string, std::filesystem::path>>;

/// The scenes that a project or a single scene file names.
struct SelectedScenes {
	std::string project;		  // name of the project, else of the scene file
	std::filesystem::path folder; // of the project or scene file
	NamedFiles scenes;			  // scenes of the report's matrix (MATRIX_GROUP); at least one
	std::map<std::string, NamedFiles> part_scenes; // see Project::part_scenes
};
/// Selects the scenes of the project or scene file. --scenes and --skip restrict
/// SelectedScenes::scenes, but not part_scenes. Throws an Error if the project does not exist,
/// two scenes of one list have the same name or no scene remains in `scenes`, and a UsageError for
/// an unknown scene in --scenes.
SelectedScenes select_scenes(const ReportArguments &p_arguments);

} // namespace gnomon
