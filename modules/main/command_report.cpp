// `gnomon report`: error against run time of every technique over a project's scenes.

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/project.h"
#include "modules/error_report/report_comparison.h"
#include "modules/error_report/report_csv.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/report_page.h"
#include "modules/error_report/report_ranking.h"
#include "modules/error_report/run_report.h"
#include "modules/main/commands.h"
#include "modules/main/rendered_masks.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

const char *const DEFAULT_SIZE = "256x256";
const double MAX_LIGHT_SIZE_M = 1e4;

struct ReportArguments {
	std::string project;
	std::vector<std::string> scenes;
	std::vector<std::string> techniques;
	std::vector<double> sizes_m;
	std::vector<std::string> light_types;
	std::string size = DEFAULT_SIZE;
	uint32_t sample_count = 1024;
	std::string scaling = "quick";
	double precision_percent = 5; // a third of what --against calls a change
	std::string out;
	bool resumes = false;
	std::string against;
	std::optional<double> budget_ms;
	std::string shard;
	std::vector<std::string> merged;
	std::string merge_out;
};

/// Prints what the user asks for beside the files, and adds it to the report's JSON.
bool add_answers(const Report &p_report, const ReportArguments &p_arguments, Json &r_json) {
	if (p_arguments.budget_ms) {
		Json choices = Json::array();
		std::printf("Least error within %g ms:\n", *p_arguments.budget_ms);
		for (size_t index = 0; index < p_report.configurations.size(); ++index) {
			const ReportConfiguration &configuration = p_report.configurations[index];
			if (!configuration.has_truth()) {
				continue;
			}
			Json choice = { { "configuration", index } };
			const auto best = find_within_budget(p_report, index, *p_arguments.budget_ms);
			if (best) {
				const ReportCell &cell = p_report.cells[*best];
				choice["cell"] = *best;
				std::printf("  %s: %s, %s: penumbra MAE %.4f in %.2f ms\n",
						configuration.id.c_str(), cell.technique.c_str(), cell.setting.c_str(),
						cell.error->all.penumbra.mae, cell.time.cost_ms);
			} else {
				std::printf("  %s: nothing is that quick\n", configuration.id.c_str());
			}
			choices.push_back(std::move(choice));
		}
		r_json["budget"] = { { "budget_ms", *p_arguments.budget_ms }, { "choices", choices } };
	}
	if (p_arguments.against.empty()) {
		return true;
	}
	const ReportComparison comparison = compare_reports(load_report(p_arguments.against), p_report);
	std::printf("%s", to_text(comparison).c_str());
	for (const ReportDifference &difference : comparison.differences) {
		if (difference.is_worse && difference.what == "time") {
			log_warning(difference.configuration, ", ", difference.technique, ", ",
					difference.setting, " is slower than before.");
		}
	}
	r_json["against"] = to_json(comparison);
	return !comparison.has_regression();
}

void print_ranking(const Report &p_report) {
	std::printf(
			"%-16s %-18s %12s %10s %8s\n", "technique", "setting", "penumbra MAE", "ms", "cells");
	for (const RankingRow &row : rank_settings(p_report)) {
		std::printf("%-16s %-18s %12.4f %10.2f %8zu\n", row.technique.c_str(), row.setting.c_str(),
				row.penumbra_mae, row.cost_ms, row.configuration_count);
	}
}

/// Writes the files. Fails when something of the plan failed, is missing or got worse.
void finish_report(const Report &p_report, const fs::path &p_folder,
		const ReportArguments &p_arguments, bool p_may_miss) {
	Json json = to_json(p_report);
	const bool is_no_worse = add_answers(p_report, p_arguments, json);
	const RecordStore store(get_record_folder(p_folder));
	save_file_atomically(p_folder / "report.json", json.dump(1) + "\n");
	save_file_atomically(p_folder / "report.csv", to_csv(p_report));
	save_file_atomically(p_folder / "index.html", build_report_page(json, store));
	print_ranking(p_report);
	std::printf("Page: %s\n", (p_folder / "index.html").string().c_str());
	const size_t failed_count = p_report.count(ReportStatus::FAILED);
	const size_t missing_count = p_report.count(ReportStatus::MISSING);
	if (failed_count > 0) {
		fail(failed_count, " truths or cells failed; the page says which and why. Mend that, then ",
				"go on with --resume.");
	}
	if (missing_count > 0 && !p_may_miss) {
		fail(missing_count, " truths or cells are missing. Run the other shards, or go on with ",
				"--resume.");
	}
	if (!is_no_worse) {
		fail("Errors grew against ", p_arguments.against, "; the lines above say where.");
	}
}

LightType parse_light_type(const std::string &p_name) {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		if (p_name == get_light_type_name(type)) {
			return type;
		}
	}
	throw UsageError(text("--light-types: \"", p_name,
			"\" must be own, or of spot, omni and directional, comma separated."));
}

RunOptions parse_run_options(const ReportArguments &p_arguments) {
	RunOptions options;
	options.resumes = p_arguments.resumes;
	if (!p_arguments.shard.empty()) {
		unsigned index = 0;
		unsigned count = 0;
		char rest = 0;
		if (std::sscanf(p_arguments.shard.c_str(), "%u/%u%c", &index, &count, &rest) != 2 ||
				index < 1 || index > count) {
			throw UsageError(text("--shard is \"", p_arguments.shard,
					"\", must be I/N with 1 <= I <= N, for example 2/8."));
		}
		options.shard_index = index - 1;
		options.shard_count = count;
	}
	return options;
}

ReportOptions make_options(const ReportArguments &p_arguments, const std::string &p_project) {
	ReportOptions options;
	options.project = p_project;
	options.program = describe_program();
	for (const double size_m : p_arguments.sizes_m) {
		if (!std::isfinite(size_m) || size_m < 0 || size_m > MAX_LIGHT_SIZE_M) {
			throw UsageError(text("--sizes: ", size_m, " must be 0..", MAX_LIGHT_SIZE_M,
					" m, the light's radius."));
		}
		auto &sizes_m = options.sizes_m;
		if (std::find(sizes_m.begin(), sizes_m.end(), size_m) == sizes_m.end()) {
			sizes_m.push_back(size_m);
		}
	}
	if (p_arguments.light_types != std::vector<std::string>{ "own" }) {
		for (const std::string &name : p_arguments.light_types) {
			options.light_types.push_back(parse_light_type(name));
		}
	}
	options.size_px = parse_size(p_arguments.size);
	options.sample_count = p_arguments.sample_count;
	options.scaling = p_arguments.scaling == "none" ? ScalingExtent::NONE
			: p_arguments.scaling == "full"			? ScalingExtent::FULL
													: ScalingExtent::QUICK;
	return options;
}

/// Names and files of the scenes to do.
std::vector<std::pair<std::string, fs::path>> select_scenes(
		const ReportArguments &p_arguments, fs::path &r_folder, std::string &r_project) {
	const fs::path path = p_arguments.project;
	std::error_code code;
	std::vector<fs::path> files = { path };
	if (fs::is_directory(path, code) || path.extension() == ".cfg") {
		const Project project = Project::load(path);
		r_folder = project.folder;
		r_project = project.name.empty() ? fs::absolute(project.folder).filename().string()
										 : project.name;
		files = project.scenes;
		for (const fs::path &missing : project.missing_scenes) {
			log_warning("Scene ", missing, " does not exist and is left out.");
		}
	} else {
		r_folder = fs::absolute(path).parent_path();
		r_project = path.stem().string();
	}
	std::map<std::string, fs::path> by_name;
	std::string names;
	std::vector<std::pair<std::string, fs::path>> selected;
	for (const fs::path &file : files) {
		const std::string name = file.stem().string();
		names += (names.empty() ? "" : ", ") + name;
		by_name[name] = file;
		const auto &wanted = p_arguments.scenes;
		if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end()) {
			selected.push_back({ name, file });
		}
	}
	for (const std::string &name : p_arguments.scenes) {
		if (by_name.count(name) == 0) {
			throw UsageError(text("--scenes: there is no \"", name, "\", must be of ", names, "."));
		}
	}
	if (selected.empty()) {
		fail("Project ", r_folder, " names no scene that exists. Set scenes in its project.cfg.");
	}
	return selected;
}

void run_report_command(const ReportArguments &p_arguments, const CommonOptions &p_common) {
	const RunOptions run_options = parse_run_options(p_arguments);
	if (!p_arguments.against.empty()) {
		load_report(p_arguments.against); // an unreadable one is known now, not in an hour
	}
	fs::path folder;
	std::string project;
	const auto files = select_scenes(p_arguments, folder, project);
	const ReportOptions options = make_options(p_arguments, project);
	std::vector<ReportScene> scenes;
	for (const auto &[name, path] : files) {
		ReportScene scene = { name, nullptr, {} };
		try {
			scene.scene = load_scene(path);
		} catch (const Error &error) {
			log_error(error.what());
			scene.failure = error.what();
		}
		scenes.push_back(std::move(scene));
	}
	const std::vector<TechniqueSource> techniques =
			RenderedMasks::find_techniques(p_arguments.techniques);
	const fs::path out =
			p_arguments.out.empty() ? folder / "out" / "report" : fs::path(p_arguments.out);
	RecordStore store(get_record_folder(out));
	const std::unique_ptr<RenderingDevice> device = create_device(p_common);
	const ReportPlan plan = make_report_plan(options, scenes, techniques);
	save_plan(out, plan.report);
	log_info("Report: ", plan.report.configurations.size(), " configurations, ",
			plan.report.cells.size(), " cells.");
	RenderedMasks source(*device, p_arguments.precision_percent / 100);
	const Report report = run_report(plan, source, store, run_options);
	finish_report(report, out, p_arguments, run_options.shard_count > 1);
}

void run_merge_command(const ReportArguments &p_arguments) {
	const std::vector<fs::path> folders(p_arguments.merged.begin(), p_arguments.merged.end());
	const Report report = merge_reports(folders, p_arguments.merge_out);
	finish_report(report, p_arguments.merge_out, p_arguments, false);
}

} // namespace

void add_report_command(CLI::App &r_app, CommonOptions &r_common) {
	static ReportArguments arguments;
	CLI::App *command = r_app.add_subcommand(
			"report", "Error against run time of every technique, as a page with plots");
	command->add_option("project", arguments.project, "A project, or one .gltf or .glb file");
	command->add_option("--scenes", arguments.scenes, "A,B: these scenes only")->delimiter(',');
	command->add_option("--techniques", arguments.techniques, "A,B: these techniques only")
			->delimiter(',');
	command->add_option("--sizes", arguments.sizes_m,
				   "Radii of the light in metres; default 0.02, 0.1 and 0.3 of the scene's size")
			->delimiter(',');
	command->add_option("--light-types", arguments.light_types,
				   "own (default): each scene's lights as they are; else spot,omni,directional")
			->delimiter(',')
			->default_val(std::vector<std::string>{ "own" });
	command->add_option("--size", arguments.size, "Of the picture; default 256x256");
	command->add_option(
				   "--samples", arguments.sample_count, "Of the truth, per pixel; default 1024")
			->check(CLI::Range(1u, 65536u));
	command->add_option("--scaling", arguments.scaling, "Curves of cost: none, quick or full")
			->check(CLI::IsMember({ "none", "quick", "full" }));
	command->add_option("--precision", arguments.precision_percent,
				   "Percent: a cell may end before 20 frames once its median is known so well; 0 = "
				   "never")
			->check(CLI::Range(0.0, 100.0));
	command->add_option("--out", arguments.out, "Folder; default PROJECT/out/report");
	command->add_flag("--resume", arguments.resumes, "Goes on with a run that was stopped");
	command->add_option("--against", arguments.against,
			"An older report.json: says what changed; errors that grew end with 1");
	command->add_option("--budget", arguments.budget_ms,
				   "Milliseconds: names the technique of least error for each scene")
			->check(CLI::PositiveNumber);
	command->add_option("--shard", arguments.shard, "I/N: this part only, for N machines");
	command->add_option("--device", r_common.device, "Index or part of the name");
	command->add_flag("--validation", r_common.validation, "Validation layers on");
	CLI::App *merge = command->add_subcommand("merge", "Makes one report of the parts of --shard");
	merge->add_option("folders", arguments.merged, "Folders that the parts were written to")
			->required();
	merge->add_option("--out", arguments.merge_out, "Folder of the whole report")->required();
	merge->callback([] { run_merge_command(arguments); });
	command->callback([command, merge, &r_common] {
		if (merge->parsed()) {
			return;
		}
		if (arguments.project.empty()) {
			throw UsageError(
					"report: PROJECT is missing. Name a folder with project.cfg, or a scene.");
		}
		run_report_command(arguments, r_common);
	});
}

} // namespace gnomon
