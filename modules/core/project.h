#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// A project.cfg: sections of key=value in Godot's ConfigFile style, where a value is a "text", a
/// list ["a", "b"], a number, true or false. Lines that begin with ; or # are comments.
class Project {
public:
	std::filesystem::path folder; // everything a project uses is below it
	std::string name;
	std::filesystem::path start_scene;		   // absolute; empty = none named
	std::vector<std::filesystem::path> scenes; // absolute paths of the listed scenes that exist
	/// Absolute paths of the listed scenes that exist and that a report draws in its stability
	/// sweeps, in addition to `scenes`.
	std::vector<std::filesystem::path> stability_scenes;
	/// Absolute paths of listed scenes that do not exist, without duplicates.
	std::vector<std::filesystem::path> missing_scenes;
	std::vector<std::string> disabled_modules;
	/// The [defaults] section as written, without quotes.
	std::map<std::string, std::string> defaults;
	/// The [technique.ID] sections as written, without quotes; by ID.
	std::map<std::string, std::map<std::string, std::string>> technique_settings;

	/// p_path: the folder or its project.cfg. A missing or malformed file is an Error with the
	/// line.
	static Project load(const std::filesystem::path &p_path);
	/// Parses the text of a project.cfg; p_path is where that file is.
	static Project parse(const std::string &p_text, const std::filesystem::path &p_path);
	/// Writes disabled_modules into project.cfg and leaves everything else in the file unchanged.
	/// Does nothing when there is no project.cfg.
	void save_disabled_modules() const;
	/// Returns the text of a project.cfg with the given list of disabled modules and everything
	/// else unchanged. p_path names the file in the Error that malformed text causes.
	static std::string replace_disabled_modules(const std::string &p_text,
			const std::vector<std::string> &p_modules, const std::filesystem::path &p_path);
	/// The nearest folder at or above the file's that has a project.cfg; else the file's folder.
	static std::filesystem::path find_folder(const std::filesystem::path &p_scene_path);

private:
	void add_scenes(
			const std::vector<std::string> &p_names, std::vector<std::filesystem::path> &r_scenes);
};

/// The project and scene that a path on the command line names.
struct ProjectScene {
	/// The project at the path, or the one that contains the scene. Without a project.cfg, only its
	/// folder is set: that of the scene.
	Project project;
	std::filesystem::path scene_path; // of the .gltf or .glb file
};

/// p_path: a project's folder, its project.cfg, or a scene. A project without a scene is an Error.
ProjectScene find_project_scene(const std::filesystem::path &p_path);

/// Switches off the modules that the project disables. A module that this build lacks only causes a
/// warning, so that the project opens with every build.
void disable_modules(const Project &p_project);

} // namespace gnomon
