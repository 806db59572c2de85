#pragma once

#include "modules/core/extension_registry.h"

#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace gnomon {

/// Options that every command has.
struct CommonOptions {
	std::string device; // index of the device, or part of its name; empty: the best device
	bool validation = false;
	/// For commands that draw scenes, see stage_scene: "auto", "on" or "off".
	std::string stage = "auto";
	/// For commands that draw scenes: name of the animation; empty: the first.
	std::string animation;
	std::optional<double> at_s; // time in the animation, seconds; empty: the scene is drawn at rest
};

struct CommandInfo {
	static constexpr int LAST = 100;

	std::string id; // its word on the command line
	/// Called once, before the command line is parsed, to add the subcommand. If the user chose
	/// that subcommand, it runs inside CLI11's parse.
	std::function<void(CLI::App &r_app, CommonOptions &r_common)> add;
	int help_order = LAST; // position in --help, ascending; equal values are sorted by id
};

/// The commands of this build. Modules add theirs at ModuleLevel::FEATURES.
class CommandRegistry : public ExtensionRegistry<CommandInfo> {};

} // namespace gnomon
