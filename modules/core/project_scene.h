#pragma once

#include "modules/core/project.h"

#include <filesystem>

namespace gnomon {

/// What a path on the command line names.
struct ProjectScene {
	/// The project that the path is, or that the scene lies in. Without a project.cfg it has a
	/// folder alone: the scene's.
	Project project;
	std::filesystem::path scene_path; // of the .gltf or .glb file
};

/// p_path: a project's folder, its project.cfg, or a scene. A project without a scene is an Error.
ProjectScene find_project_scene(const std::filesystem::path &p_path);

/// Switches off the modules that the project names. A name of another build only warns: the project
/// must open everywhere.
void disable_modules(const Project &p_project);

} // namespace gnomon
