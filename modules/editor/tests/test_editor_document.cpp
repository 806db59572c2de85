#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/module_registry.h"
#include "modules/core/tests/killed_process.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/editor/editor_document.h"
#include "modules/scene/node_properties.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

/// A copy of one scene of the demo project, as a project of its own.
struct EditedProject : TemporaryFolder {
	fs::path scene = path / "contact_box.gltf";

	EditedProject() {
		for (const char *name : { "contact_box.gltf", "contact_box.bin" }) {
			fs::copy_file(fs::path("demo_project/scenes") / name, path / name);
		}
		save_file_atomically(path / "project.cfg",
				std::string_view("[project]\nstart_scene=\"contact_box.gltf\"\n"));
	}
};

Light3D &find_light(EditorDocument &r_document) {
	return *r_document.get_scene().find_nodes<Light3D>().at(0);
}

double get_light_size(EditorDocument &r_document) {
	return std::get<double>(get_node_property(find_light(r_document), "light_size"));
}

/// Simulates a full disk: while it exists, this process cannot write files longer than p_bytes.
class FullDisk {
public:
	explicit FullDisk(rlim_t p_bytes) {
		signal_before = std::signal(SIGXFSZ, SIG_IGN);
		::getrlimit(RLIMIT_FSIZE, &before);
		const rlimit full = { p_bytes, before.rlim_max };
		::setrlimit(RLIMIT_FSIZE, &full);
	}
	~FullDisk() {
		::setrlimit(RLIMIT_FSIZE, &before);
		std::signal(SIGXFSZ, signal_before);
	}

private:
	rlimit before = {};
	void (*signal_before)(int) = nullptr;
};

const double INITIAL_LIGHT_SIZE = 0.4; // of the light in contact_box.gltf
const EditorDocument::Clock::time_point START{};
const auto LATER = START + 2 * EditorDocument::AUTOSAVE_INTERVAL;

} // namespace

TEST_CASE("[EditorDocument] saving a change leaves the rest of the file unchanged") {
	const EditedProject project;
	const std::string before = load_text_file(project.scene);
	EditorDocument document(project.path);
	CHECK_FALSE(document.is_changed());
	document.set_property(find_light(document), "light_size", 0.75);
	CHECK(document.is_changed());
	document.save();
	CHECK_FALSE(document.is_changed());
	CHECK(get_light_size(document) == 0.75);
	EditorDocument again(project.scene);
	CHECK(get_light_size(again) == 0.75);
	again.set_property(find_light(again), "light_size", INITIAL_LIGHT_SIZE);
	again.save();
	CHECK(load_text_file(project.scene) == before);
}

TEST_CASE("[EditorDocument] unsaved changes are autosaved and can be recovered") {
	const EditedProject project;
	{
		EditorDocument document(project.path);
		CHECK(document.autosave(START));
		CHECK_FALSE(document.has_recovery());
		document.set_property(find_light(document), "light_size", 0.75);
		CHECK(document.autosave(START)); // the interval begins
		CHECK_FALSE(document.has_recovery());
		document.set_autosave_interval(4 * EditorDocument::AUTOSAVE_INTERVAL);
		CHECK(document.autosave(LATER));
		CHECK_FALSE(document.has_recovery());
		document.set_autosave_interval(EditorDocument::AUTOSAVE_INTERVAL);
		CHECK(document.autosave(LATER));
		CHECK(document.has_recovery());
	} // as if the program had ended without saving
	EditorDocument document(project.path);
	REQUIRE(document.has_recovery());
	CHECK(get_light_size(document) == INITIAL_LIGHT_SIZE);
	document.recover();
	CHECK(get_light_size(document) == 0.75);
	CHECK(document.is_changed());
	document.save();
	CHECK_FALSE(document.has_recovery());
	CHECK(get_light_size(*std::make_unique<EditorDocument>(project.path)) == 0.75);
}

TEST_CASE("[EditorDocument] a kill at any step of saving loses no completed autosave or save") {
	const EditedProject project;
	const std::string before = load_text_file(project.scene);
	// Run N is killed after step N. Steps 1 to 4 save the recovery file, 5 to 8 the scene. The
	// ninth run is not killed.
	const size_t FILE_STEP_COUNT = 4; // created, written, synced, renamed
	size_t run = 0;
	const auto edit = [&] {
		EditorDocument document(project.path);
		document.set_property(find_light(document), "light_size", 0.75);
		document.save_recovery();
		document.save();
	};
	const size_t kill_count = kill_at_each_save_step(edit, [&] {
		++run;
		EditorDocument document(project.path);
		CHECK(document.get_failure().empty());
		const bool is_saved = get_light_size(document) == 0.75;
		CHECK(document.has_recovery() == (run >= FILE_STEP_COUNT && run <= 2 * FILE_STEP_COUNT));
		if (document.has_recovery()) {
			document.recover();
			CHECK(get_light_size(document) == 0.75);
			document.discard_recovery();
		} else {
			CHECK(is_saved == (run > 2 * FILE_STEP_COUNT));
		}
		save_file_atomically(project.scene, before);
		remove_left_over_files(project.path);
	});
	CHECK(kill_count == 2 * FILE_STEP_COUNT);
}

TEST_CASE("[EditorDocument] an earlier session's recovery file stays until it is discarded") {
	const EditedProject project;
	{
		EditorDocument document(project.path);
		document.set_property(find_light(document), "light_size", 0.75);
		document.save_recovery();
	}
	{
		EditorDocument document(project.path); // opened and closed without a decision
		REQUIRE(document.has_recovery());
	}
	EditorDocument document(project.path);
	REQUIRE(document.has_recovery());
	document.discard_recovery();
	document.set_property(find_light(document), "light_size", 0.5);
	document.save();
	document.undo(); // which is a change of the saved state
	document.autosave(START);
	document.autosave(LATER);
	CHECK(document.has_recovery());
}

TEST_CASE("[EditorDocument] switching a module preserves the project's names of unknown modules") {
	const EditedProject project;
	save_file_atomically(project.path / "project.cfg",
			std::string_view("[project]\nstart_scene=\"contact_box.gltf\"\n[modules]\n"
							 "disabled=[\"of_another_build\"]\n"));
	EditorDocument document(project.path);
	std::string name; // of the last one: modules that depend on others come after them
	for (const ModuleInfo &module : ModuleRegistry::get_modules()) {
		name = module.can_disable ? module.name : name;
	}
	if (name.empty()) {
		return;
	}
	document.set_module_enabled(name, false);
	CHECK(Project::load(project.path).disabled_modules ==
			std::vector<std::string>{ "of_another_build", name });
	document.set_module_enabled(name, true);
	CHECK(Project::load(project.path).disabled_modules ==
			std::vector<std::string>{ "of_another_build" });
}

TEST_CASE("[EditorDocument] failing to write or read a file loses no changes") {
	const EditedProject project;
	EditorDocument document(project.path);
	document.set_property(find_light(document), "light_size", 0.75);
	CHECK_THROWS_AS(document.save_as(project.path / "missing" / "a.gltf"), Error);
	CHECK(document.is_changed());
	CHECK(document.get_path().filename() == "contact_box.gltf");
	CHECK(get_light_size(document) == 0.75);
	save_file_atomically(project.scene, std::string_view("{ broken"));
	CHECK_THROWS_AS(document.reload(), Error);
	CHECK(get_light_size(document) == 0.75);
	CHECK(document.get_history().can_undo());
	document.save(); // overwrites the broken file
	CHECK(get_light_size(*std::make_unique<EditorDocument>(project.path)) == 0.75);
}

TEST_CASE("[EditorDocument] names stay unique, and duplicates and removals can be undone") {
	const EditedProject project;
	EditorDocument document(project.path);
	Light3D &light = find_light(document);
	CHECK_THROWS_AS(document.rename(light, ""), Error);
	const std::string other = document.get_scene().find_nodes<Camera3D>().at(0)->name;
	CHECK_THROWS_WITH_AS(document.rename(light, other), doctest::Contains("already"), Error);
	document.duplicate(light);
	REQUIRE(document.get_selected() != nullptr);
	CHECK(document.get_selected()->name == light.name + " 2");
	document.set_property(*document.get_selected(), "light_size", 0.1);
	document.save();
	EditorDocument again(project.path);
	REQUIRE(again.get_scene().find_nodes<Light3D>().size() == 2);
	CHECK(get_light_size(again) == INITIAL_LIGHT_SIZE);
	document.undo();
	document.undo();
	CHECK(document.get_scene().find_nodes<Light3D>().size() == 1);
	CHECK(document.get_selected() == nullptr);
	document.remove(light);
	CHECK(document.get_scene().find_nodes<Light3D>().empty());
	document.undo();
	CHECK(document.get_selected() == &light);
	CHECK_THROWS_AS(document.remove(*document.get_scene().root), Error);
}

TEST_CASE("[EditorDocument] another program's change to the file is detected until it is "
		  "reloaded") {
	const EditedProject project;
	EditorDocument document(project.path);
	CHECK_FALSE(document.is_file_newer());
	fs::last_write_time(project.scene, fs::file_time_type::clock::now() + std::chrono::hours(1));
	CHECK(document.is_file_newer());
	const std::string name = find_light(document).name;
	document.select(&find_light(document));
	document.reload();
	CHECK(document.get_selected() == &find_light(document));
	CHECK(document.get_selected()->name == name);
	CHECK_FALSE(document.is_file_newer());
	document.save();
	CHECK_FALSE(document.is_file_newer());
}

TEST_CASE("[EditorDocument] a change to a file that the scene refers to is detected") {
	const EditedProject project;
	EditorDocument document(project.path);
	const auto later = fs::file_time_type::clock::now() + std::chrono::hours(1);
	fs::last_write_time(project.path / "contact_box.bin", later);
	CHECK(document.is_file_newer());
	document.reload();
	CHECK_FALSE(document.is_file_newer());
	// A missing scene file is no change: another program may be about to replace it.
	fs::rename(project.scene, project.path / "away");
	CHECK_FALSE(document.is_file_newer());
}

TEST_CASE("[EditorDocument] a full disk or a missing folder loses no changes") {
	const EditedProject project;
	const std::string before = load_text_file(project.scene);
	EditorDocument document(project.path);
	document.set_property(find_light(document), "light_size", 0.75);
	{
		const FullDisk full(200); // shorter than the scene file
		CHECK_THROWS_AS(document.save(), Error);
		document.autosave(START);
		CHECK_FALSE(document.autosave(LATER)); // logged, and retried later
	}
	const fs::path away = project.path.string() + "_away";
	fs::rename(project.path, away);
	CHECK_THROWS_AS(document.save(), Error);
	fs::rename(away, project.path);
	CHECK(document.is_changed());
	CHECK(get_light_size(document) == 0.75);
	CHECK(load_text_file(project.scene) == before);
	// No temporary file is left: only the scene, its .bin and project.cfg.
	CHECK(std::distance(fs::directory_iterator(project.path), fs::directory_iterator()) == 3);
	document.save();
	CHECK_FALSE(document.is_changed());
	CHECK(get_light_size(*std::make_unique<EditorDocument>(project.path)) == 0.75);
}

TEST_CASE("[EditorDocument] an unreadable scene opens empty, is not overwritten, and reloads after "
		  "repair") {
	const EditedProject project;
	const std::string whole = load_text_file(project.scene);
	save_file_atomically(project.scene, std::string_view("{ \"asset\""));
	EditorDocument document(project.path);
	CHECK(document.get_failure().find("contact_box.gltf") != std::string::npos);
	CHECK(document.get_scene().root->children.empty());
	CHECK_FALSE(document.is_changed());
	CHECK_THROWS_AS(document.save(), Error);
	CHECK(load_text_file(project.scene) == "{ \"asset\"");
	CHECK_FALSE(document.is_file_newer());
	save_file_atomically(project.scene, std::string_view(whole));
	fs::last_write_time(project.scene, fs::file_time_type::clock::now() + std::chrono::hours(1));
	CHECK(document.is_file_newer());
	document.reload();
	CHECK(document.get_failure().empty());
	CHECK(get_light_size(document) == INITIAL_LIGHT_SIZE);
	document.save();
}

TEST_CASE("[EditorDocument] opening a missing scene is an error") {
	const EditedProject project;
	CHECK_THROWS_AS(EditorDocument(project.path / "none.gltf"), Error);
}

TEST_CASE("[EditorDocument] a recovery file that cannot be read is renamed, not lost") {
	const EditedProject project;
	EditorDocument document(project.path);
	const fs::path recovery_path = document.get_recovery_path();
	save_file_atomically(recovery_path, std::string_view("{ broken"));
	CHECK(document.has_recovery());
	CHECK_THROWS_AS(document.recover(), Error);
	CHECK_FALSE(document.has_recovery());
	CHECK(get_light_size(document) == INITIAL_LIGHT_SIZE);
	document.set_property(find_light(document), "light_size", 0.5);
	document.save();
	CHECK(load_text_file(recovery_path.string() + ".unread") == "{ broken");
}

TEST_CASE("[EditorDocument] saving preserves an earlier session's recovery file") {
	const EditedProject project;
	EditorDocument document(project.path);
	fs::copy_file(project.scene, document.get_recovery_path());
	document.set_property(find_light(document), "light_size", 0.5);
	document.save();
	CHECK(document.has_recovery());
	document.discard_recovery();
	CHECK_FALSE(document.has_recovery());
}
