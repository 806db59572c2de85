#include "modules/core/project.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <sstream>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

constexpr uint64_t MAX_PROJECT_BYTES = 1 << 20;

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

/// ["a", "b"]; the caller has checked the brackets.
std::vector<std::string> parse_list(const std::string &p_text) {
	std::vector<std::string> items;
	std::stringstream stream(p_text.substr(1, p_text.size() - 2));
	for (std::string item; std::getline(stream, item, ',');) {
		if (!trim(item).empty()) {
			items.push_back(unquote(trim(item)));
		}
	}
	return items;
}

} // namespace

Project Project::load(const fs::path &p_path) {
	const fs::path path = fs::is_directory(p_path) ? p_path / "project.cfg" : p_path;
	if (!fs::exists(path)) {
		fail("Project ", p_path, " has no project.cfg. Name a project's folder or a .gltf file.");
	}
	return parse(load_text_file(path, MAX_PROJECT_BYTES), path);
}

Project Project::parse(const std::string &p_text, const fs::path &p_path) {
	Project project;
	project.folder = fs::absolute(p_path).parent_path();
	std::stringstream stream(p_text);
	std::string section;
	int line_number = 0;
	for (std::string line; std::getline(stream, line);) {
		++line_number;
		line = trim(line);
		if (line.empty() || line[0] == ';' || line[0] == '#') {
			continue;
		}
		if (line.front() == '[' && line.back() == ']' && line.find('=') == std::string::npos) {
			section = line.substr(1, line.size() - 2);
			continue;
		}
		const size_t equals = line.find('=');
		if (equals == std::string::npos) {
			fail(p_path, ":", line_number, ": \"", line,
					"\" is no section, comment or key=value. Mend the line.");
		}
		const std::string key = trim(line.substr(0, equals));
		std::string value = trim(line.substr(equals + 1));
		// A list may go on over several lines.
		for (std::string more; !value.empty() && value.front() == '[' && value.back() != ']';) {
			if (!std::getline(stream, more)) {
				fail(p_path, ":", line_number, ": the list of ", key, " has no end. Add a ].");
			}
			++line_number;
			value = trim(value + trim(more));
		}
		const bool is_list = !value.empty() && value.front() == '[';
		if (section == "project" && key == "name") {
			project.name = unquote(value);
		} else if (section == "project" && key == "start_scene") {
			project.start_scene = project.folder / unquote(value);
		} else if (section == "project" && key == "scenes" && is_list) {
			for (const std::string &scene : parse_list(value)) {
				const fs::path scene_path = project.folder / scene;
				const bool is_there = fs::exists(scene_path);
				(is_there ? project.scenes : project.missing_scenes).push_back(scene_path);
			}
		} else if (section == "modules" && key == "disabled" && is_list) {
			project.disabled_modules = parse_list(value);
		} else if (section == "defaults") {
			project.defaults[key] = unquote(value);
		}
	}
	return project;
}

void Project::save_disabled_modules() const {
	const fs::path path = folder / "project.cfg";
	if (!fs::exists(path)) {
		return;
	}
	save_file_atomically(path,
			std::string_view(replace_disabled_modules(
					load_text_file(path, MAX_PROJECT_BYTES), disabled_modules)));
}

std::string Project::replace_disabled_modules(
		const std::string &p_text, const std::vector<std::string> &p_modules) {
	std::string list;
	for (const std::string &module : p_modules) {
		list += (list.empty() ? "\"" : ", \"") + module + "\"";
	}
	const std::string wanted = "disabled=[" + list + "]\n";
	std::stringstream stream(p_text);
	std::string lines;
	std::string section;
	bool is_written = false;
	for (std::string line; std::getline(stream, line);) {
		const std::string words = trim(line);
		if (words.size() > 1 && words.front() == '[' && words.back() == ']' &&
				words.find('=') == std::string::npos) {
			section = words.substr(1, words.size() - 2);
			lines += line + "\n" + (section == "modules" && !is_written ? wanted : std::string());
			is_written |= section == "modules";
			continue;
		}
		const size_t equals = words.find('=');
		if (section == "modules" && equals != std::string::npos &&
				trim(words.substr(0, equals)) == "disabled") {
			std::string list_end = trim(words.substr(equals + 1));
			const bool is_list = !list_end.empty() && list_end.front() == '[';
			while (is_list && list_end.back() != ']' && std::getline(stream, line)) {
				list_end += trim(line); // the rest of the list that is replaced
			}
			continue;
		}
		lines += line + "\n";
	}
	return is_written ? lines : lines + "\n[modules]\n" + wanted;
}

fs::path Project::find_folder(const fs::path &p_scene_path) {
	const fs::path scene_folder = fs::absolute(p_scene_path).parent_path();
	for (fs::path folder = scene_folder; !folder.empty(); folder = folder.parent_path()) {
		if (fs::exists(folder / "project.cfg")) {
			return folder;
		}
		if (folder == folder.root_path()) {
			break;
		}
	}
	return scene_folder;
}

} // namespace gnomon
