#include "modules/core/project_scene.h"

#include "modules/core/error.h"
#include "modules/core/log.h"
#include "modules/core/module_registry.h"

namespace gnomon {

namespace fs = std::filesystem;

namespace {

fs::path choose_start_scene(const Project &p_project) {
	if (!p_project.start_scene.empty()) {
		return p_project.start_scene;
	}
	if (p_project.scenes.empty()) {
		fail("Project ", p_project.folder,
				" names no scene that exists. Set start_scene in its project.cfg.");
	}
	return p_project.scenes.front();
}

} // namespace

ProjectScene find_project_scene(const fs::path &p_path) {
	ProjectScene place;
	place.project.folder = Project::find_folder(p_path);
	place.scene_path = p_path;
	std::error_code code;
	const bool is_project = fs::is_directory(p_path, code) || p_path.extension() == ".cfg";
	if (is_project || fs::exists(place.project.folder / "project.cfg", code)) {
		place.project = Project::load(is_project ? p_path : place.project.folder);
		if (is_project) {
			place.scene_path = choose_start_scene(place.project);
		}
	}
	return place;
}

void disable_modules(const Project &p_project) {
	for (const std::string &name : p_project.disabled_modules) {
		try {
			ModuleRegistry::set_enabled(name, false);
		} catch (const Error &error) {
			log_warning((p_project.folder / "project.cfg").string(), ": ", error.what());
		}
	}
}

} // namespace gnomon
