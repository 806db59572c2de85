#include "modules/shader_reload/shader_watcher.h"

#include "modules/core/embedded_shaders.h"
#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/shader_reload/shader_compiler.h"

#include <algorithm>

namespace gnomon {

namespace fs = std::filesystem;

ShaderWatcher::ShaderWatcher(fs::path p_folder) : folder(std::move(p_folder)) {
	for (const EmbeddedShader &shader : get_embedded_shaders()) {
		std::error_code code;
		const std::string file = find_shader_source(std::string(shader.name)).file;
		if (fs::is_regular_file(folder / file, code)) {
			entry_points.emplace_back(shader.name);
			add_file(file);
		}
	}
}

void ShaderWatcher::add_file(const std::string &p_name) {
	std::error_code code;
	const fs::file_time_type time = fs::last_write_time(folder / p_name, code);
	if (code || files.contains(p_name)) {
		return; // the compiler reports a missing include
	}
	File &file = files[p_name];
	file.time = time;
	try {
		file.includes = find_includes(load_text_file(folder / p_name));
	} catch (const Error &) {
		return; // deleted since its time was read
	}
	for (const std::string &name : std::vector<std::string>(file.includes)) {
		add_file(name);
	}
}

std::set<std::string> ShaderWatcher::find_all_files(const std::string &p_name) const {
	std::set<std::string> all;
	std::vector<std::string> pending = { p_name };
	while (!pending.empty()) {
		const std::string name = pending.back();
		pending.pop_back();
		if (!all.insert(name).second) {
			continue;
		}
		if (const auto found = files.find(name); found != files.end()) {
			pending.insert(
					pending.end(), found->second.includes.begin(), found->second.includes.end());
		}
	}
	return all;
}

std::set<std::string> ShaderWatcher::find_changed_files() {
	std::set<std::string> changed;
	for (const auto &[name, file] : files) {
		std::error_code code;
		const fs::file_time_type time = fs::last_write_time(folder / name, code);
		if (!code && time != file.time) {
			changed.insert(name);
		}
	}
	// Includes that were missing are not in `files`; they are found through the files that include
	// them. A deleted file stays in `files` with its old time, so that the loop above finds it once
	// it exists again.
	for (const auto &[name, file] : std::map<std::string, File>(files)) {
		for (const std::string &include : file.includes) {
			if (!files.contains(include)) {
				add_file(include);
				if (files.contains(include)) {
					changed.insert(include);
				}
			}
		}
	}
	return changed;
}

std::vector<ShaderChange> ShaderWatcher::poll() {
	const std::set<std::string> changed = find_changed_files();
	std::vector<ShaderChange> changes;
	if (changed.empty()) {
		return changes;
	}
	for (const std::string &name : changed) {
		files.erase(name);
	}
	for (const std::string &name : changed) {
		// Reads its includes again, since they may have changed. If the file was deleted since
		// find_changed_files, it is now missing from `files`: an include is found again through the
		// files that include it, an entry point is not found again.
		add_file(name);
	}
	for (const std::string &name : entry_points) {
		const std::set<std::string> used = find_all_files(find_shader_source(name).file);
		const bool is_affected = std::any_of(used.begin(), used.end(),
				[&](const std::string &p_file) { return changed.contains(p_file); });
		if (!is_affected) {
			continue;
		}
		ShaderChange change;
		change.name = name;
		try {
			change.spirv = compile_shader(folder, name);
		} catch (const Error &error) {
			change.failure = error.what();
		}
		changes.push_back(std::move(change));
	}
	return changes;
}

} // namespace gnomon
