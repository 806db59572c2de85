#pragma once

#include "modules/core/files.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace gnomon {

/// Adds an option whose value is the UTF-8 text of a path. r_path must live until the command line
/// has been parsed. CLI11's own conversion to paths depends on the system, see make_path.
inline CLI::Option *add_path_option(CLI::App &r_command, const std::string &p_name,
		std::filesystem::path &r_path, const std::string &p_description) {
	return r_command.add_option_function<std::string>(
			p_name, [&r_path](const std::string &p_text) { r_path = make_path(p_text); },
			p_description);
}

/// Adds an option that has several such values.
inline CLI::Option *add_path_option(CLI::App &r_command, const std::string &p_name,
		std::vector<std::filesystem::path> &r_paths, const std::string &p_description) {
	const auto assign = [&r_paths](const std::vector<std::string> &p_texts) {
		r_paths.clear();
		for (const std::string &text : p_texts) {
			r_paths.push_back(make_path(text));
		}
	};
	return r_command.add_option_function<std::vector<std::string>>(p_name, assign, p_description);
}

} // namespace gnomon
