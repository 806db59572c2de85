#include "modules/main/report_arguments.h"

#include "modules/core/error.h"
#include "modules/core/limits.h"
#include "modules/core/log.h"
#include "modules/core/project.h"
#include "modules/error_report/report_part.h"
#include "modules/main/commands.h"
#include "modules/shadows/mask_filter.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

LightType parse_light_type(const std::string &p_name) {
	for (const LightType type : { LightType::SPOT, LightType::OMNI, LightType::DIRECTIONAL }) {
		if (p_name == get_light_type_name(type)) {
			return type;
		}
	}
	throw UsageError(text("--light-types: \"", p_name,
			"\" must be own, or some of spot, omni and directional, separated by commas."));
}

NamedFiles name_files(const std::vector<fs::path> &p_files, const fs::path &p_folder) {
	NamedFiles named;
	std::map<std::string, fs::path> by_name;
	for (const fs::path &file : p_files) {
		const std::string name = file.stem().string();
		if (!by_name.insert({ name, file }).second) {
			fail("Project ", p_folder, ": two scenes are named \"", name, "\", ", by_name[name],
					" and ", file, ". Rename one: the report identifies scenes by their names.");
		}
		named.push_back({ name, file });
	}
	return named;
}

/// Returns whether the pattern matches the whole name. A * in it is any text, also none.
bool matches_pattern(std::string_view p_pattern, std::string_view p_name) {
	const size_t star = p_pattern.find('*');
	if (star == std::string_view::npos) {
		return p_pattern == p_name;
	}
	if (!p_name.starts_with(p_pattern.substr(0, star))) {
		return false;
	}
	p_name.remove_prefix(star);
	p_pattern.remove_prefix(star + 1);
	// Each part between stars is best found as early as possible; only the last must be at the end.
	for (size_t next; (next = p_pattern.find('*')) != std::string_view::npos;) {
		const size_t found = p_name.find(p_pattern.substr(0, next));
		if (found == std::string_view::npos) {
			return false;
		}
		p_name.remove_prefix(found + next);
		p_pattern.remove_prefix(next + 1);
	}
	return p_name.ends_with(p_pattern);
}

} // namespace

void check_names(const char *p_option, const std::vector<std::string> &p_requested,
		const std::vector<std::string> &p_valid_names) {
	std::string names;
	for (const std::string &name : p_valid_names) {
		names += (names.empty() ? "" : ", ") + name;
	}
	for (const std::string &name : p_requested) {
		if (std::ranges::find(p_valid_names, name) == p_valid_names.end()) {
			throw UsageError(
					text(p_option, ": there is no \"", name, "\", must be one of ", names, "."));
		}
	}
}

ReportRunOptions parse_run_options(const ReportArguments &p_arguments) {
	ReportRunOptions options;
	options.resumes = p_arguments.resumes;
	if (!p_arguments.shard.empty()) {
		const size_t slash = p_arguments.shard.find('/');
		const std::string_view shard = p_arguments.shard;
		uint32_t index = 0;
		uint32_t count = 0;
		if (slash == std::string::npos || !parse_uint32(shard.substr(0, slash), index) ||
				!parse_uint32(shard.substr(slash + 1), count) || index < 1 || index > count) {
			throw UsageError(text("--shard is \"", p_arguments.shard,
					"\", must be I/N with 1 <= I <= N, for example 2/8."));
		}
		options.shard_index = index - 1;
		options.shard_count = count;
	}
	return options;
}

ReportOptions make_report_options(
		const ReportArguments &p_arguments, const std::string &p_project) {
	ReportOptions options = p_arguments.options;
	options.project = p_project;
	options.program = describe_program();
	options.filter_hash = compute_filter_hash();
	options.has_default_settings = p_arguments.settings == "default";
	options.has_own_sizes = p_arguments.sizes == std::vector<std::string>{ "own" };
	for (const std::string &size : p_arguments.sizes) {
		if (options.has_own_sizes) {
			break;
		}
		double size_m = -1;
		const auto parsed = std::from_chars(size.data(), size.data() + size.size(), size_m);
		if (parsed.ec != std::errc() || parsed.ptr != size.data() + size.size() ||
				!std::isfinite(size_m) || size_m < 0 || size_m > MAX_LENGTH_M) {
			throw UsageError(text("--sizes: ", size, " must be 0..", MAX_LENGTH_M,
					" m, the light's radius, or own alone."));
		}
		auto &sizes_m = options.sizes_m;
		if (std::find(sizes_m.begin(), sizes_m.end(), size_m) == sizes_m.end()) {
			sizes_m.push_back(size_m);
		}
	}
	if (p_arguments.light_types != std::vector<std::string>{ "own" }) {
		for (const std::string &name : p_arguments.light_types) {
			const LightType type = parse_light_type(name);
			auto &types = options.light_types;
			if (std::find(types.begin(), types.end(), type) == types.end()) {
				types.push_back(type);
			}
		}
	}
	options.size_px = parse_size(p_arguments.size);
	options.scaling = parse_extent(p_arguments.scaling);
	for (const ReportPartInfo &info : ReportPartRegistry::get_all()) {
		for (const ReportPartOption &option : info.part->list_options()) {
			check_names(option.name.c_str(), options.get_part_option(option.name), option.values);
		}
	}
	return options;
}

SelectedScenes select_scenes(const ReportArguments &p_arguments) {
	const fs::path path = p_arguments.project;
	std::error_code code;
	if (!fs::exists(path, code)) {
		fail("Project ", path, " does not exist. Name a folder with project.cfg, or a scene file.");
	}
	SelectedScenes selected;
	NamedFiles all;
	if (fs::is_directory(path, code) || path.extension() == ".cfg") {
		const Project project = Project::load(path);
		selected.folder = project.folder;
		selected.project = project.name.empty() ? fs::absolute(project.folder).filename().string()
												: project.name;
		for (const fs::path &missing : project.missing_scenes) {
			log_warning("Scene ", missing, " does not exist and is skipped.");
		}
		all = name_files(project.scenes, project.folder);
		for (const auto &[part, files] : project.part_scenes) {
			selected.part_scenes[part] = name_files(files, project.folder);
		}
	} else {
		selected.folder = fs::absolute(path).parent_path();
		selected.project = path.stem().string();
		all = { { selected.project, path } };
	}
	const auto &requested = p_arguments.scenes;
	std::vector<std::string> names;
	for (const auto &[name, file] : all) {
		names.push_back(name);
		const bool is_skipped = std::ranges::any_of(p_arguments.skipped_scenes,
				[&](const std::string &p_pattern) { return matches_pattern(p_pattern, name); });
		if (!is_skipped &&
				(requested.empty() ||
						std::find(requested.begin(), requested.end(), name) != requested.end())) {
			selected.scenes.push_back({ name, file });
		}
	}
	check_names("--scenes", requested, names);
	if (selected.scenes.empty()) {
		fail("Project ", selected.folder,
				all.empty() ? " names no scene that exists. Set scenes in its project.cfg."
							: ": --skip excludes every selected scene. Skip fewer.");
	}
	return selected;
}

} // namespace gnomon
