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
	std::vector<std::filesystem::path> scenes; // absolute; those that exist
	/// Absolute; those that exist of what a report also draws with its stability sweeps.
	std::vector<std::filesystem::path> stability_scenes;
	std::vector<std::filesystem::path> missing_scenes; // absolute; listed, but not there; each once
	std::vector<std::string> disabled_modules;
	std::map<std::string, std::string> defaults; // [defaults] as written, quotes removed
	/// Of each [technique.ID], the same; by ID.
	std::map<std::string, std::map<std::string, std::string>> technique_settings;

	/// p_path: the folder or its project.cfg. A missing or malformed file is an Error with the
	/// line.
	static Project load(const std::filesystem::path &p_path);
	/// The same for the text of a project.cfg that is at p_path.
	static Project parse(const std::string &p_text, const std::filesystem::path &p_path);
	/// Writes disabled_modules into project.cfg and leaves all else in it as it is. Without a
	/// project.cfg nothing is stored.
	void save_disabled_modules() const;
	/// The text of a project.cfg with that list of disabled modules, all else as it was. p_path:
	/// for the Error that malformed text is.
	static std::string replace_disabled_modules(const std::string &p_text,
			const std::vector<std::string> &p_modules, const std::filesystem::path &p_path);
	/// The nearest folder at or above the file's that has a project.cfg; else the file's folder.
	static std::filesystem::path find_folder(const std::filesystem::path &p_scene_path);

private:
	void add_scenes(
			const std::vector<std::string> &p_names, std::vector<std::filesystem::path> &r_scenes);
};

/// What a path on the command line names.
struct ProjectScene {
	/// The project that the path is, or that the scene is in. Without a project.cfg it has a
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
