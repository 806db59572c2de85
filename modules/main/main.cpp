// Initializes the modules, parses the command line and runs one command. Exit codes: 0 success, 1
// failure, 2 wrong usage. An error is printed as one line on stderr.

#include "modules/core/command_registry.h"
#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"
#include "modules/main/commands.h"
#include "modules/main/register_types.h"
#include "modules/rendering_device/rendering_device.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace {

using namespace gnomon;

/// Optional commands, each with the module that it needs.
const std::pair<const char *, const char *> MODULES_OF_COMMANDS[] = { { "edit", "editor" },
	{ "visibility", "masks" }, { "compare", "masks" }, { "report", "error_report" } };

/// Throws a UsageError for an unknown command. If the command needs a module that this build lacks,
/// the message names the module; otherwise it lists the commands.
void check_command(const CLI::App &p_app, const std::string &p_command) {
	for (const auto &[command, module] : MODULES_OF_COMMANDS) {
		const auto has_name = [&](const CLI::App *p_found) {
			return p_found->get_name() == p_command;
		};
		if (p_command == command && p_app.get_subcommands(has_name).empty()) {
			throw UsageError(text("`gnomon ", command, "` needs the module ", module,
					", which this build lacks. Build with module_", module, "_enabled=yes."));
		}
	}
	std::string names;
	for (const CLI::App *command : p_app.get_subcommands(/*filter=*/{})) { // all
		if (command->get_name() == p_command) {
			return;
		}
		names += (names.empty() ? "" : ", ") + command->get_name();
	}
	if (!p_command.starts_with('-')) {
		throw UsageError(text("\"", p_command, "\" is no command, must be one of ", names,
				". `gnomon --help` lists what they do."));
	}
}

/// Returns the commands in the order of --help.
std::vector<CommandInfo> list_commands() {
	std::vector<CommandInfo> commands = CommandRegistry::get_all();
	std::ranges::sort(commands, {}, [](const CommandInfo &p_command) {
		return std::tie(p_command.help_order, p_command.id);
	});
	return commands;
}

int run_program(int p_argument_count, char **p_arguments) {
	CLI::App app("Gnomon: soft shadows that are measured against the exact ones.", "gnomon");
	app.require_subcommand(1);
	app.allow_windows_style_options(false); // there, by default, /path would be an option
	app.set_version_flag("--version", std::string("gnomon ") + PROGRAM_VERSION);
	CommonOptions common;
	for (const CommandInfo &command : list_commands()) {
		command.add(app, common);
	}
	if (p_argument_count > 1) {
		check_command(app, p_arguments[1]);
	}
	try {
		app.parse(p_argument_count, p_arguments);
	} catch (const CLI::ParseError &error) {
		if (error.get_exit_code() == 0) {
			return app.exit(error); // --help, --version
		}
		const std::string problem = error.what();
		log_error(problem, problem.ends_with('.') ? "" : ".",
				" `gnomon --help` and `gnomon COMMAND --help` list commands and options.");
		return 2;
	}
	if (common.validation && get_validation_message_count() > 0) {
		log_error("The validation layers reported ", get_validation_message_count(),
				" errors or warnings; the lines above list them.");
		return 1;
	}
	return 0;
}

} // namespace

int gnomon::run_gnomon(int p_argument_count, char **p_arguments) {
	int result = 1;
	try {
		register_modules();
		ModuleRegistry::initialize(ModuleLevel::FEATURES);
		initialize_main_module(
				ModuleLevel::FEATURES); // not in the registry, because tests link without main
		result = run_program(p_argument_count, p_arguments);
	} catch (const UsageError &error) {
		log_error(error.what());
		result = 2;
	} catch (const std::exception &error) {
		log_error(describe_failure(error));
	}
	errno = 0;
	if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
		log_error("The output cannot be written", errno != 0 ? ": " : "",
				errno != 0 ? std::strerror(errno) : "",
				". Check the free space of what it is redirected to.");
		result = 1;
	}
	uninitialize_main_module(ModuleLevel::FEATURES);
	ModuleRegistry::uninitialize();
	if (has_device_hung()) {
		std::fflush(nullptr);
		std::_Exit(result); // a normal exit would wait for the hung driver's threads
	}
	return result;
}
