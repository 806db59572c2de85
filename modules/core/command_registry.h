#pragma once

#include "modules/core/extension_registry.h"

#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace gnomon {

/// Options that several commands share.
struct CommonOptions {
	std::string device; // index of the device, or part of its name; empty: the best usable one
	bool validation = false;
	/// For commands that draw scenes: whether a camera, a light and a ground are added, "auto",
	/// "on" or "off"; see stage_scene.
	std::string stage = "auto";
	/// For commands that draw scenes: name of the animation; empty: `run` takes the project's, else
	/// the first, other commands the first if at_s is set, else none.
	std::string animation;
	std::optional<double> at_s; // time in the animation, seconds; unset: its start
};

struct CommandInfo {
	static constexpr int LAST = 100; // help_order of commands that do not set one

	std::string id; // name of the subcommand on the command line
	/// Called once, before the command line is parsed, to add the subcommand. If the user chose
	/// that subcommand, it runs inside CLI11's parse.
	std::function<void(CLI::App &r_app, CommonOptions &r_common)> add;
	int help_order = LAST; // position in --help, ascending; equal values are sorted by id
};

/// Lists the commands of this build. Modules add theirs at ModuleLevel::FEATURES.
class CommandRegistry : public ExtensionRegistry<CommandInfo> {};

} // namespace gnomon
