#pragma once

#include "modules/core/extension_registry.h"

#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace gnomon {

/// Options of every command.
struct CommonOptions {
	std::string device; // index or part of the name; empty: the best
	bool validation = false;
	std::string stage = "auto"; // of commands that draw scenes: see stage_scene; auto, on or off
	std::string animation;		// of commands that draw scenes: its name; empty: the first
	std::optional<double> at_s; // the time of it that is drawn; empty: the scene is at rest
};

struct CommandInfo {
	static constexpr int LAST = 100;

	std::string id; // its word on the command line
	/// Called once, before the command line is read: adds the subcommand. When that is chosen, it
	/// runs inside CLI11's parse.
	std::function<void(CLI::App &r_app, CommonOptions &r_common)> add;
	int help_order = LAST; // in --help, rising; those of equal order by id
};

/// The commands of this build. Modules add theirs at ModuleLevel::FEATURES.
class CommandRegistry : public ExtensionRegistry<CommandInfo> {};

} // namespace gnomon
