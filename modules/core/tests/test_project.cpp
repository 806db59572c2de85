#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/project.h"
#include "modules/core/tests/temporary_folder.h"

#include <doctest/doctest.h>

#include <filesystem>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

struct ProjectFolder : TemporaryFolder {
	explicit ProjectFolder(const std::string &p_text) {
		save_file_atomically(path / "project.cfg", p_text);
		fs::create_directory(path / "scenes");
		save_file_atomically(path / "scenes" / "a.gltf", "{}");
	}
};

} // namespace

TEST_CASE("[Project] names, lists over several lines, comments and defaults are parsed") {
	const ProjectFolder folder(
			"; a comment\n[project]\nname=\"Demo\"\n"
			"start_scene=\"scenes/a.gltf\"\n"
			"scenes=[\"scenes/a.gltf\",\n  \"scenes/b.gltf\"]\n\n"
			"[modules]\ndisabled=[\"one\", \"two\"]\n[defaults]\nsize=\"64x64\"\n");
	const Project project = Project::load(folder.path);
	CHECK(project.name == "Demo");
	CHECK(project.start_scene == folder.path / "scenes/a.gltf");
	CHECK(project.scenes == std::vector<fs::path>{ folder.path / "scenes/a.gltf" });
	CHECK(project.missing_scenes == std::vector<fs::path>{ folder.path / "scenes/b.gltf" });
	CHECK(project.disabled_modules == std::vector<std::string>{ "one", "two" });
	CHECK(project.defaults.at("size") == "64x64");
	CHECK(Project::find_folder(folder.path / "scenes" / "a.gltf") == folder.path);
}

TEST_CASE(
		"[Project] stability_scenes is a separate list, and a scene missing in both lists is named "
		"once") {
	const ProjectFolder folder("[project]\nscenes=[\"scenes/b.gltf\"]\n"
							   "stability_scenes=[\"scenes/a.gltf\", \"scenes/b.gltf\"]\n");
	const Project project = Project::load(folder.path);
	CHECK(project.scenes.empty());
	CHECK(project.part_scenes.at("stability") ==
			std::vector<fs::path>{ folder.path / "scenes/a.gltf" });
	CHECK(project.missing_scenes == std::vector<fs::path>{ folder.path / "scenes/b.gltf" });
}

TEST_CASE("[Project] a malformed line or a list without end is an error that locates it; an empty "
		  "value is allowed") {
	const ProjectFolder malformed("[project]\nname=\"Demo\"\nwhat is this\n");
	CHECK_THROWS_WITH_AS(Project::load(malformed.path), doctest::Contains(":3:"), Error);
	const ProjectFolder endless("[project]\nscenes=[\"a\",\n\"b\"\n");
	CHECK_THROWS_WITH_AS(Project::load(endless.path), doctest::Contains("scenes"), Error);
	const ProjectFolder empty_value("[project]\nname=\nscenes=\n");
	CHECK(Project::load(empty_value.path).name.empty());
}

TEST_CASE("[Project] a name may have commas, and a list of one item needs no brackets") {
	const ProjectFolder folder("[project]\nscenes=[\"scenes/a, b.gltf\", \"c.gltf\"]\n"
							   "stability_scenes=\"scenes/a.gltf\"\n[modules]\ndisabled=one\n");
	const Project project = Project::load(folder.path);
	CHECK(project.missing_scenes ==
			std::vector<fs::path>{ folder.path / "scenes/a, b.gltf", folder.path / "c.gltf" });
	CHECK(project.part_scenes.at("stability") ==
			std::vector<fs::path>{ folder.path / "scenes/a.gltf" });
	CHECK(project.disabled_modules == std::vector<std::string>{ "one" });
}

TEST_CASE("[Project] saving the disabled modules leaves the rest of the file unchanged") {
	const std::string before = "; a comment\n[project]\nname=\"Demo\"\n\n[modules]\n"
							   "; disabled=[\"none\"]\ndisabled=[\"one\",\n  \"two\"]\n"
							   "[defaults]\nsize=\"64x64\"\n";
	const ProjectFolder folder(before);
	Project project = Project::load(folder.path);
	for (const std::vector<std::string> &names :
			{ std::vector<std::string>{ "three" }, {}, { "a", "b" } }) {
		project.disabled_modules = names;
		project.save_disabled_modules();
		CHECK(Project::load(folder.path).disabled_modules == names);
	}
	const std::string after = load_text_file(folder.path / "project.cfg");
	CHECK(after ==
			"; a comment\n[project]\nname=\"Demo\"\n\n[modules]\n"
			"disabled=[\"a\", \"b\"]\n; disabled=[\"none\"]\n[defaults]\nsize=\"64x64\"\n");
	const ProjectFolder without_list("[modules]\ndisabled=\"x\"\n[defaults]\nsize=\"64x64\"\n");
	project.folder = without_list.path;
	project.save_disabled_modules();
	CHECK(Project::load(without_list.path).defaults.at("size") == "64x64");
	const ProjectFolder without_section("[project]\nname=\"Demo\"\n");
	project.folder = without_section.path;
	project.save_disabled_modules();
	CHECK(Project::load(without_section.path).disabled_modules ==
			std::vector<std::string>{ "a", "b" });
	CHECK(Project::load(without_section.path).name == "Demo");
}

TEST_CASE("[Project] a folder without project.cfg is an error that names it") {
	const ProjectFolder folder("");
	CHECK_THROWS_WITH_AS(Project::load(folder.path / "scenes"), doctest::Contains("scenes"), Error);
}

TEST_CASE("[Project] a list without end stops at the next section's heading with an error") {
	const std::string text = "[project]\nscenes=[\"a\",\n\"b\"\n\n[modules]\ndisabled=[\"one\"]\n";
	CHECK_THROWS_WITH_AS(
			Project::parse(text, "/none/project.cfg"), doctest::Contains(":2: the list"), Error);
}

TEST_CASE("[Project] a scene whose name is too long for the file system counts as missing") {
	const std::string long_name(5000, 'a');
	const Project project =
			Project::parse("[project]\nscenes=[\"" + long_name + "\"]\n", "/none/project.cfg");
	CHECK(project.missing_scenes == std::vector<fs::path>{ fs::absolute("/none/" + long_name) });
}

TEST_CASE("[Project] a list of 200000 lines is parsed completely") {
	std::string text = "[modules]\ndisabled=[\n";
	for (int i = 0; i < 200000; ++i) {
		text += "a,\n"; // parsing takes 0.04 s; 2.8 s if each line copied all lines before it
	}
	CHECK(Project::parse(text + "]\n", "/none/project.cfg").disabled_modules.size() == 200000);
}
