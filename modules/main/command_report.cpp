// The command `gnomon report`: measures error and run time of every technique in the scenes of a
// project.

#include "modules/core/command_registry.h"
#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/path_option.h"
#include "modules/error_report/report_comparison.h"
#include "modules/error_report/report_folder.h"
#include "modules/error_report/report_json.h"
#include "modules/error_report/report_page.h"
#include "modules/error_report/report_part.h"
#include "modules/error_report/report_ranking.h"
#include "modules/error_report/run_report.h"
#include "modules/main/commands.h"
#include "modules/main/rendered_masks.h"
#include "modules/main/report_arguments.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <optional>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

enum class MissingCells { ALLOWED, REFUSED };

/// Prints the results of --budget and --against, and adds them to the report's JSON. p_old: the
/// report to compare with, if any. Returns false if there is a regression (see
/// ReportComparison::has_regression) or if no cell was measured in both reports.
bool add_budget_and_comparison(const Report &p_report, const ReportArguments &p_arguments,
		const std::optional<Report> &p_old, Json &r_json) {
	if (p_arguments.budget_ms) {
		Json choices = Json::array();
		std::printf("Least error within %g ms:\n", *p_arguments.budget_ms);
		for (size_t index = 0; index < p_report.configurations.size(); ++index) {
			const ReportConfiguration &configuration = p_report.configurations[index];
			if (!configuration.is_matrix()) {
				continue; // of a scaling curve or a report part
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
	if (!p_old) {
		return true;
	}
	const ReportComparison comparison = compare_reports(*p_old, p_report);
	std::printf("%s", to_text(comparison).c_str());
	for (const ReportDifference &difference : comparison.differences) {
		if (difference.is_worse && difference.is_of_time()) {
			log_warning(difference.configuration, ", ", difference.technique, ", ",
					difference.setting, " is slower than before.");
		}
	}
	if (comparison.only_old_count > 0) {
		log_warning(comparison.only_old_count, " cells of ", p_arguments.against,
				" are not in this report, so that they are not compared.");
	}
	r_json["against"] = to_json(comparison);
	return !comparison.has_regression() && comparison.compared_count > 0;
}

/// Loads the report of --against; nullopt without that option. Called before the measurement, so
/// that an unreadable file fails early.
std::optional<Report> load_old_report(const ReportArguments &p_arguments) {
	return p_arguments.against.empty() ? std::nullopt
									   : std::optional(load_report(p_arguments.against));
}

void print_ranking(const Report &p_report) {
	std::printf(
			"%-16s %-18s %12s %10s %8s\n", "technique", "setting", "penumbra MAE", "ms", "cells");
	for (const RankingRow &row : rank_settings(p_report)) {
		std::printf("%-16s %-18s %12.4f %10.2f %8zu\n", row.technique.c_str(), row.setting.c_str(),
				row.penumbra_mae, row.cost_ms, row.configuration_count);
	}
}

/// Writes report.json, report.csv and index.html, and prints the ranking. Then throws an Error if a
/// reference, cell or scene image failed, if one is missing (unless MissingCells::ALLOWED), or if
/// add_budget_and_comparison returns false.
void finish_report(const Report &p_report, const fs::path &p_folder,
		const ReportArguments &p_arguments, const std::optional<Report> &p_old,
		MissingCells p_missing) {
	Json json = to_json(p_report);
	const bool passes_comparison = add_budget_and_comparison(p_report, p_arguments, p_old, json);
	const RecordStore store(get_record_folder(p_folder));
	save_file_atomically(p_folder / "report.json", dump_json(json));
	save_file_atomically(p_folder / "report.csv", to_csv(p_report));
	save_file_atomically(p_folder / "index.html", build_report_page(json, store));
	print_ranking(p_report);
	std::printf("Page: %s\n", (p_folder / "index.html").string().c_str());
	const size_t failed_count = p_report.count(ReportStatus::FAILED);
	const size_t missing_count = p_report.count(ReportStatus::MISSING);
	if (failed_count > 0) {
		fail(failed_count,
				" references, cells or scene images failed; the page lists which and why. Fix "
				"that, then repeat the `gnomon report` that measured them, with --resume.");
	}
	if (missing_count > 0 && p_missing == MissingCells::REFUSED) {
		fail(missing_count, " references or cells are missing. Run the other shards, or repeat ",
				"`gnomon report` with --resume.");
	}
	if (!passes_comparison) {
		fail("Errors grew against ", p_arguments.against,
				", or cells failed that did not before (the lines above list them), or no cell was "
				"measured in both.");
	}
}

/// While it exists, each warning is logged only the first time and its repetitions are counted. The
/// destructor logs the counts.
class WarningCounter {
public:
	~WarningCounter() {
		scope.reset();
		for (const auto &[line, count] : counts) {
			if (count > 1) {
				log_warning(count, " times: ", line);
			}
		}
	}

private:
	std::map<std::string, size_t> counts;
	std::optional<LogFilterScope> scope{ std::in_place,
		[this](LogLevel p_level, const std::string &p_line) {
			return p_level != LogLevel::WARNING || ++counts[p_line] == 1;
		} };
};

std::vector<ReportScene> load_scenes(
		const NamedFiles &p_files, const CommonOptions &p_common, glm::uvec2 p_size_px) {
	std::vector<ReportScene> scenes;
	for (const auto &[name, path] : p_files) {
		ReportScene scene = { name, /*scene=*/nullptr, /*failure=*/{} };
		try {
			scene.scene = load_scene(path, p_common, p_size_px);
		} catch (const Error &error) {
			log_error(error.what());
			scene.failure = error.what();
		}
		scenes.push_back(std::move(scene));
	}
	return scenes;
}

void run_report_command(const ReportArguments &p_arguments, const CommonOptions &p_common) {
	const WarningCounter warning_counter;
	ReportRunOptions run_options = parse_run_options(p_arguments);
	const std::optional<Report> old_report = load_old_report(p_arguments);
	const SelectedScenes selected = select_scenes(p_arguments);
	ReportOptions options = make_report_options(p_arguments, selected.project);
	const std::vector<ReportScene> scenes = load_scenes(selected.scenes, p_common, options.size_px);
	for (const auto &[id, files] : selected.part_scenes) {
		const ReportPart *part = ReportPartRegistry::find_part(id);
		if (part != nullptr && part->needs_own_scenes(options)) {
			options.part_scenes[id] = load_scenes(files, p_common, options.size_px);
		}
	}
	if (std::none_of(scenes.begin(), scenes.end(),
				[](const ReportScene &p_scene) { return p_scene.scene != nullptr; })) {
		fail("No scene of ", p_arguments.project, " can be loaded; the lines above state why.");
	}
	const std::vector<MeasurableTechnique> techniques =
			RenderedMaskSource::find_techniques(p_arguments.techniques);
	const fs::path out =
			p_arguments.out.empty() ? selected.folder / "out" / "report" : p_arguments.out;
	const ReportPlan plan = make_report_plan(options, scenes, techniques);
	if (run_options.resumes) {
		check_resumable(out, plan.report);
	}
	RecordStore store(get_record_folder(out));
	const std::unique_ptr<RenderingDevice> device = create_device(p_common);
	save_plan(out, plan.report);
	log_info("Report: ", plan.report.configurations.size(), " configurations, ",
			plan.report.cells.size(), " cells.");
	RenderedMaskSource source(*device, options.precision_percent / 100, p_arguments.frame_count);
	run_options.on_progress = [&, next = std::chrono::steady_clock::time_point()](
									  const Report &p_report) mutable {
		if (std::chrono::steady_clock::now() < next) {
			return;
		}
		save_file_atomically(out / "index.html", build_report_page(to_json(p_report), store));
		// At most every 20 s, since building the page takes time.
		next = std::chrono::steady_clock::now() + std::chrono::seconds(20);
	};
	const Report report = run_report(plan, source, store, run_options);
	const bool is_shard = run_options.shard_count > 1;
	// A shard also reports the records that other shards have written to the same folder.
	finish_report(is_shard ? collect_report(plan.report, store) : report, out, p_arguments,
			old_report, is_shard ? MissingCells::ALLOWED : MissingCells::REFUSED);
}

void run_merge_command(const ReportArguments &p_arguments) {
	const std::optional<Report> old_report = load_old_report(p_arguments);
	const Report report = merge_reports(p_arguments.merged, p_arguments.merge_out);
	finish_report(report, p_arguments.merge_out, p_arguments, old_report, MissingCells::REFUSED);
}

/// Adds the options that the report parts of this build declare, and, hidden, those of parts that
/// it lacks, for which any value but "none" is a UsageError.
void add_part_options(CLI::App &r_command, ReportOptions &r_options) {
	for (const ReportPartInfo &info : ReportPartRegistry::get_all()) {
		for (const ReportPartOption &option : info.part->list_options()) {
			std::vector<std::string> &values = r_options.part_options[option.name];
			values = option.default_values;
			CLI::Option *added = r_command.add_option(option.name, values, option.help);
			if (option.is_list) {
				added->delimiter(',');
			} else {
				added->expected(1)->allow_extra_args(false)->check(CLI::IsMember(option.values));
			}
		}
	}
	for (const MissingOption &missing : get_missing_report_options()) {
		r_command
				.add_option_function<std::vector<std::string>>(missing.name,
						[missing](const std::vector<std::string> &p_values) {
							if (p_values == std::vector<std::string>{ "none" }) {
								return;
							}
							throw UsageError(text("`gnomon report ", missing.name,
									"` needs the module ", missing.module,
									", which this build lacks. Build with module_", missing.module,
									"_enabled=yes."));
						})
				->allow_extra_args(false)
				->group(""); // not in --help
	}
}

void add_report_command(CLI::App &r_app, CommonOptions &r_common) {
	static ReportArguments arguments;
	CLI::App *command = r_app.add_subcommand(
			"report", "Error against run time of every technique, as a page with plots");
	add_path_option(*command, "project", arguments.project, "A project, or one .gltf or .glb file");
	command->add_option("--scenes", arguments.scenes, "A,B: these scenes only")->delimiter(',');
	command->add_option("--techniques", arguments.techniques, "A,B: these techniques only")
			->delimiter(',');
	command->add_option(
				   "--skip", arguments.skipped_scenes, "A,B*: all scenes but these; * is any text")
			->delimiter(',');
	command->add_option("--sizes", arguments.sizes,
				   "Radii of the light in metres; default 0.02, 0.1 and 0.3 of the scene's size; "
				   "own: each light's own")
			->delimiter(',');
	command->add_option("--settings", arguments.settings,
				   "all (default): each technique's quality levels; default: its defaults alone")
			->check(CLI::IsMember({ "all", "default" }));
	command->add_option("--frames", arguments.frame_count,
				   "Maximum number of frames that a cell is timed for; default 20")
			->check(CLI::Range(1u, 1000u));
	command->add_option("--light-types", arguments.light_types,
				   "own (default): each scene's lights as they are; else spot,omni,directional: "
				   "the first light of each scene as each of these types")
			->delimiter(',')
			->default_val(std::vector<std::string>{ "own" });
	command->add_option("--size", arguments.size, "Size of the masks in pixels; default 256x256");
	add_stage_option(*command, r_common);
	add_animation_options(*command, r_common);
	command->add_option("--samples", arguments.options.sample_count,
				   "Rays of the reference per pixel; default 1024")
			->check(CLI::Range(1u, 65536u));
	command->add_option("--scaling", arguments.scaling,
				   "Curves of run time: none, quick (default) or full")
			->check(CLI::IsMember({ "none", "quick", "full" }));
	add_part_options(*command, arguments.options);
	command->add_option("--precision", arguments.options.precision_percent,
				   "Percent: timing of a cell ends early once the standard error of its median is "
				   "at most this; 0 = never; default 5")
			->check(CLI::Range(0.0, 100.0));
	add_path_option(*command, "--out", arguments.out, "Folder; default PROJECT/out/report");
	command->add_flag("--resume", arguments.resumes, "Goes on with a run that was stopped");
	command->add_option("--shard", arguments.shard,
			"I/N: only the I-th of N shards, to split the work among N machines");
	command->add_option("--device", r_common.device, "Index or part of the name");
	command->add_flag("--validation", r_common.validation, "Validation layers on");
	CLI::App *merge =
			command->add_subcommand("merge", "Merges the folders of shards into one report");
	add_path_option(*merge, "folders", arguments.merged, "Folders that the shards were written to")
			->required();
	add_path_option(*merge, "--out", arguments.merge_out, "Folder of the merged report")
			->required();
	for (CLI::App *any : { command, merge }) {
		add_path_option(*any, "--against", arguments.against,
				"An older report.json: reports what changed; exit code 1 if an error grew, if a "
				"cell no longer works, or if none was measured in both");
		any->add_option("--budget", arguments.budget_ms,
				   "Milliseconds: names the technique and setting of least error within this time, "
				   "for each scene, light and light size")
				->check(CLI::PositiveNumber);
	}
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

} // namespace

void initialize_error_report_part() {
	CommandRegistry::add({ "report", &add_report_command });
}

void uninitialize_error_report_part() {
	CommandRegistry::remove("report");
}

} // namespace gnomon
