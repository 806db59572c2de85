#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace gnomon {

/// The contents of a project.cfg: sections of key=value in Godot's ConfigFile style, where a value
/// is a "text", a list ["a", "b"], a number, true or false. Lines that begin with ; or # are
/// comments. Unknown sections and keys are ignored.
class Project {
public:
	std::filesystem::path folder; // absolute; contains all files of the project
	std::string name;
	std::filesystem::path start_scene;		   // absolute; empty: none given
	std::vector<std::filesystem::path> scenes; // absolute paths of the listed scenes that exist
	/// Absolute paths of the scenes of keys PART_scenes that exist, by PART, such as "stability". A
	/// report draws these in its part of that name only, and the other list, `scenes`, in all other
	/// measurements.
	std::map<std::string, std::vector<std::filesystem::path>> part_scenes;
	/// Absolute paths of the scenes of all lists that do not exist, without duplicates.
	std::vector<std::filesystem::path> missing_scenes;
	std::vector<std::string> disabled_modules;
	/// The [defaults] section (image size, antialiasing, animation) as written, without quotes.
	std::map<std::string, std::string> defaults;
	/// The [technique.ID] sections as written, without quotes; by ID.
	std::map<std::string, std::map<std::string, std::string>> technique_settings;

	/// p_path: the folder or its project.cfg. A missing file is an Error, a malformed one an Error
	/// that names the line.
	static Project load(const std::filesystem::path &p_path);
	/// Parses the text of a project.cfg. p_path: the path of that file, to which the paths in it
	/// are relative, and which messages name.
	static Project parse(const std::string &p_text, const std::filesystem::path &p_path);
	/// Writes disabled_modules into project.cfg and leaves everything else in the file unchanged.
	/// Does nothing when there is no project.cfg.
	void save_disabled_modules() const;
	/// Returns the text of a project.cfg with the given list of disabled modules and everything
	/// else unchanged. p_path names the file in the Error that malformed text causes.
	static std::string replace_disabled_modules(const std::string &p_text,
			const std::vector<std::string> &p_modules, const std::filesystem::path &p_path);
	/// Returns the scene's project folder: the nearest folder, from the scene's own upwards, that
	/// contains a project.cfg; if there is none, the scene's own folder.
	static std::filesystem::path find_folder(const std::filesystem::path &p_scene_path);

private:
	/// Appends the path of each scene to r_scenes if the file exists, else to missing_scenes.
	void add_scenes(
			const std::vector<std::string> &p_names, std::vector<std::filesystem::path> &r_scenes);
};

/// The project and the scene that a path on the command line refers to.
struct ProjectScene {
	/// The project at the path, or the one that contains the scene. If there is no project.cfg,
	/// only `folder` is set, to the scene's folder.
	Project project;
	std::filesystem::path scene_path; // of the .gltf or .glb file
};

/// Finds the scene to open and its project. p_path: a project's folder, its project.cfg, or a
/// scene. For a project, that is its start scene, else its first scene; having neither is an Error.
ProjectScene find_project_scene(const std::filesystem::path &p_path);

/// Switches off the modules that the project disables. A module that this build lacks, or that
/// cannot be disabled, only causes a warning, so that the project opens with every build.
void disable_modules(const Project &p_project);

} // namespace gnomon
