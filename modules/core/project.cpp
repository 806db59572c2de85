// There is no library for Godot's ConfigFile format; one for INI (inih) only reads, without lists.
#include "modules/core/project.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"

#include <set>
#include <sstream>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t MAX_PROJECT_BYTES = 1 << 20;
constexpr std::string_view TECHNIQUE_SECTION = "technique.";
constexpr std::string_view PART_SCENES_KEY = "_scenes"; // preceded by the name of a report part

std::string trim(const std::string &p_text) {
	const char *const blanks = " \t\r";
	const size_t begin = p_text.find_first_not_of(blanks);
	if (begin == std::string::npos) {
		return {};
	}
	return p_text.substr(begin, p_text.find_last_not_of(blanks) - begin + 1);
}

std::string unquote(const std::string &p_text) {
	const bool is_quoted = p_text.size() >= 2 && p_text.front() == '"' && p_text.back() == '"';
	return is_quoted ? p_text.substr(1, p_text.size() - 2) : p_text;
}

/// A key=value entry and the lines that it spans, counted from 0.
struct Entry {
	std::string section;
	std::string key;
	std::string value; // the lines of a list are joined
	size_t first_line = 0;
	size_t end_line = 0; // one past the last line
	bool is_list() const { return !value.empty() && value.front() == '['; }
};

/// Parses ["a", "b, c"]: commas in quotes do not separate. A value without brackets is one item.
std::vector<std::string> parse_list(const Entry &p_entry) {
	const std::string content =
			p_entry.is_list() ? p_entry.value.substr(1, p_entry.value.size() - 2) : p_entry.value;
	std::vector<std::string> items;
	std::string item;
	const auto finish_item = [&] {
		if (!trim(item).empty()) {
			items.push_back(unquote(trim(item)));
		}
		item.clear();
	};
	bool is_quoted = false;
	for (const char letter : content) {
		is_quoted = is_quoted != (letter == '"');
		if (letter == ',' && !is_quoted) {
			finish_item();
		} else {
			item += letter;
		}
	}
	finish_item();
	return items;
}

/// The lines and entries of a project.cfg. Reading and writing both use it, so that they agree on
/// how a file is interpreted.
struct Layout {
	std::vector<std::string> lines;
	std::vector<Entry> entries;
	std::map<std::string, size_t> sections; // by name: line of the section's first heading
};

bool is_heading(const std::string &p_line) {
	return p_line.size() > 1 && p_line.front() == '[' && p_line.back() == ']' &&
			p_line.find('=') == std::string::npos;
}

/// Appends lines to the list in r_entry until one ends with ]. A list without end is an Error.
void read_list(Layout &r_layout, Entry &r_entry, const fs::path &p_path) {
	while (r_entry.value.back() != ']') {
		const bool is_over = r_entry.end_line == r_layout.lines.size();
		const std::string more = is_over ? std::string() : trim(r_layout.lines[r_entry.end_line]);
		if (is_over || is_heading(more)) {
			fail(p_path, ":", r_entry.first_line + 1, ": the list of ", r_entry.key,
					" has no end. Add a ].");
		}
		r_entry.value += more;
		++r_entry.end_line;
	}
}

Layout read_layout(const std::string &p_text, const fs::path &p_path) {
	Layout layout;
	std::stringstream stream(p_text);
	for (std::string line; std::getline(stream, line);) {
		layout.lines.push_back(line);
	}
	std::string section;
	for (size_t number = 0; number < layout.lines.size(); ++number) {
		const std::string line = trim(layout.lines[number]);
		if (line.empty() || line[0] == ';' || line[0] == '#') {
			continue;
		}
		if (is_heading(line)) {
			section = line.substr(1, line.size() - 2);
			layout.sections.emplace(section, number);
			continue;
		}
		const size_t equals = line.find('=');
		if (equals == std::string::npos) {
			fail(p_path, ":", number + 1, ": \"", line,
					"\" is not a section, comment or key=value. Correct the line.");
		}
		Entry entry{ section, trim(line.substr(0, equals)), trim(line.substr(equals + 1)), number,
			number + 1 };
		if (entry.is_list()) {
			read_list(layout, entry, p_path);
		}
		number = entry.end_line - 1;
		layout.entries.push_back(std::move(entry));
	}
	return layout;
}

fs::path choose_start_scene(const Project &p_project) {
	if (!p_project.start_scene.empty()) {
		return p_project.start_scene;
	}
	if (p_project.scenes.empty()) {
		fail("Project ", p_project.folder,
				" names no scene that exists. Set start_scene in its project.cfg.");
	}
	return p_project.scenes.front();
}

} // namespace

Project Project::load(const fs::path &p_path) {
	std::error_code code;
	const fs::path path = fs::is_directory(p_path, code) ? p_path / "project.cfg" : p_path;
	if (!fs::exists(path, code)) {
		fail("There is no ", path, ". Name a project's folder or a .gltf file.");
	}
	return parse(load_text_file(path, MAX_PROJECT_BYTES), path);
}

Project Project::parse(const std::string &p_text, const fs::path &p_path) {
	Project project;
	project.folder = fs::absolute(p_path).parent_path();
	for (const Entry &entry : read_layout(p_text, p_path).entries) {
		const std::string &section = entry.section;
		const std::string &key = entry.key;
		if (section == "project" && key == "name") {
			project.name = unquote(entry.value);
		} else if (section == "project" && key == "start_scene") {
			project.start_scene = project.folder / make_path(unquote(entry.value));
		} else if (section == "project" && key == "scenes") {
			project.add_scenes(parse_list(entry), project.scenes);
		} else if (section == "project" && key.ends_with(PART_SCENES_KEY)) {
			const std::string part = key.substr(0, key.size() - PART_SCENES_KEY.size());
			project.add_scenes(parse_list(entry), project.part_scenes[part]);
		} else if (section == "modules" && key == "disabled") {
			project.disabled_modules = parse_list(entry);
		} else if (section == "defaults") {
			project.defaults[key] = unquote(entry.value);
		} else if (section.starts_with(TECHNIQUE_SECTION)) {
			project.technique_settings[section.substr(TECHNIQUE_SECTION.size())][key] =
					unquote(entry.value);
		}
	}
	std::set<fs::path> seen;
	std::erase_if(project.missing_scenes,
			[&](const fs::path &p_missing) { return !seen.insert(p_missing).second; });
	return project;
}

void Project::add_scenes(const std::vector<std::string> &p_names, std::vector<fs::path> &r_scenes) {
	for (const std::string &scene : p_names) {
		const fs::path path = folder / make_path(scene);
		std::error_code code; // with an error, as for a name that is too long, the scene is missing
		const bool scene_exists = fs::exists(path, code);
		(scene_exists ? r_scenes : missing_scenes).push_back(path);
	}
}

void Project::save_disabled_modules() const {
	const fs::path path = folder / "project.cfg";
	std::error_code code;
	if (!fs::exists(path, code)) {
		return;
	}
	const std::string before = load_text_file(path, MAX_PROJECT_BYTES);
	save_file_atomically(
			path, std::string_view(replace_disabled_modules(before, disabled_modules, path)));
}

std::string Project::replace_disabled_modules(const std::string &p_text,
		const std::vector<std::string> &p_modules, const fs::path &p_path) {
	std::string list;
	for (const std::string &module : p_modules) {
		list += (list.empty() ? "\"" : ", \"") + module + "\"";
	}
	const std::string new_entry = "disabled=[" + list + "]\n";
	const Layout layout = read_layout(p_text, p_path);
	const auto heading = layout.sections.find("modules");
	std::string lines;
	auto entry = layout.entries.begin();
	for (size_t number = 0; number < layout.lines.size(); ++number) {
		for (; entry != layout.entries.end() && entry->end_line <= number; ++entry) {
		}
		const bool is_replaced = entry != layout.entries.end() && entry->first_line <= number &&
				entry->section == "modules" && entry->key == "disabled";
		lines += is_replaced ? "" : layout.lines[number] + "\n";
		if (heading != layout.sections.end() && heading->second == number) {
			lines += new_entry;
		}
	}
	return heading != layout.sections.end() ? lines : lines + "\n[modules]\n" + new_entry;
}

fs::path Project::find_folder(const fs::path &p_scene_path) {
	const fs::path scene_folder = fs::absolute(p_scene_path).parent_path();
	for (fs::path folder = scene_folder; !folder.empty(); folder = folder.parent_path()) {
		std::error_code code;
		if (fs::exists(folder / "project.cfg", code)) {
			return folder;
		}
		if (folder == folder.root_path()) {
			break;
		}
	}
	return scene_folder;
}

ProjectScene find_project_scene(const fs::path &p_path) {
	ProjectScene found;
	found.project.folder = Project::find_folder(p_path);
	found.scene_path = p_path;
	std::error_code code;
	const bool is_project = fs::is_directory(p_path, code) || p_path.extension() == ".cfg";
	if (is_project || fs::exists(found.project.folder / "project.cfg", code)) {
		found.project = Project::load(is_project ? p_path : found.project.folder);
		if (is_project) {
			found.scene_path = choose_start_scene(found.project);
		}
	}
	return found;
}

void disable_modules(const Project &p_project) {
	for (const std::string &name : p_project.disabled_modules) {
		try {
			ModuleRegistry::set_enabled(name, false);
		} catch (const Error &error) {
			log_warning((p_project.folder / "project.cfg").string(), ": ", error.what());
		}
	}
}

} // namespace gnomon
