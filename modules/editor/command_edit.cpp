// The subcommand `gnomon edit`, which opens the editor's window.

#include "modules/editor/command_edit.h"

#include "modules/core/operating_system.h"
#include "modules/core/path_option.h"
#include "modules/editor/editor_window.h"

#include <CLI/CLI.hpp>

#include <filesystem>

namespace gnomon {

namespace {

EditorOptions options; // not local, because the parser fills it in after add_edit_command

} // namespace

void add_edit_command(CLI::App &r_app, CommonOptions &r_common) {
	CLI::App *command = r_app.add_subcommand("edit", "Opens a project or a scene in the editor");
	add_path_option(*command, "project", options.path,
			"A project's folder, or a .gltf or .glb file. Default: the last opened scene");
	add_path_option(*command, "--shaders", options.shaders,
			"Shader sources, recompiled when they change. Default: next to bin");
	add_path_option(
			*command, "--items", options.items, "File for the widgets' positions, for tests");
	command->add_option("--frames", options.frame_count, "Ends after this many frames")
			->check(CLI::Range(1u, 1000000u));
	command->add_option("--device", r_common.device, "Index or part of the name");
	command->add_flag("--validation", r_common.validation, "Validation layers on");
	command->add_option("--stage", r_common.stage,
				   "auto (default): a scene without camera gets one, and a scene without light "
				   "gets a light and a ground; on: it gets all three; off: nothing. They are saved "
				   "only if `staged` is switched off in the inspector")
			->check(CLI::IsMember({ "auto", "on", "off" }));
	command->callback([&r_common] {
		options.stage = parse_stage_mode(r_common.stage, "--stage");
		options.device = r_common.device;
		options.validation = r_common.validation;
		options.program = find_program_path();
		if (options.shaders.empty()) {
			options.shaders = options.program.parent_path().parent_path() / "shaders";
		}
		run_editor(options);
	});
}

} // namespace gnomon
