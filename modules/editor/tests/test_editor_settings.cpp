#include "modules/core/files.h"
#include "modules/core/tests/temporary_folder.h"
#include "modules/editor/editor_settings.h"

#include <doctest/doctest.h>

using namespace gnomon;

namespace {

void write(const TemporaryConfig &p_folder, std::string_view p_text) {
	save_file_atomically(p_folder.path / "editor.json", p_text);
}

} // namespace

TEST_CASE("[EditorSettings] saved settings are loaded again") {
	const TemporaryConfig folder;
	EditorSettings settings = EditorSettings::load();
	CHECK(settings.recent.empty());
	settings.layout.left = 0.25f;
	settings.window_size_px = glm::uvec2(1600, 900);
	settings.tab = "Error";
	settings.sample_count = 256;
	settings.shows_penumbra = false;
	settings.autosave_s = 60;
	settings.add_recent("/a/b.gltf");
	settings.save();
	const EditorSettings again = EditorSettings::load();
	CHECK(again.layout.left == 0.25f);
	CHECK(again.layout.right == EditorLayout().right);
	CHECK(again.window_size_px == glm::uvec2(1600, 900));
	CHECK(again.tab == "Error");
	CHECK(again.sample_count == 256);
	CHECK_FALSE(again.shows_penumbra);
	CHECK(again.autosave_s == 60);
	CHECK(again.recent == std::vector<std::string>{ "/a/b.gltf" });
}

TEST_CASE("[EditorSettings] recent scenes are listed newest first, each once, at most ten") {
	EditorSettings settings;
	for (int number = 0; number < 12; ++number) {
		settings.add_recent("/scenes/" + std::to_string(number) + ".gltf");
	}
	settings.add_recent("/scenes/x/../8.gltf");
	REQUIRE(settings.recent.size() == EditorSettings::MAX_RECENT_COUNT);
	CHECK(settings.recent[0] == "/scenes/8.gltf");
	CHECK(settings.recent[1] == "/scenes/11.gltf");
	CHECK(settings.recent[9] == "/scenes/2.gltf");
}

TEST_CASE("[EditorSettings] find_recent returns the newest scene that still exists") {
	const TemporaryFolder folder;
	EditorSettings settings;
	CHECK(settings.find_recent().empty());
	save_file_atomically(folder.path / "there.gltf", std::string_view("{}"));
	settings.add_recent(folder.path / "there.gltf");
	settings.add_recent(folder.path / "gone.gltf");
	CHECK(settings.find_recent() == folder.path / "there.gltf");
}

TEST_CASE("[EditorSettings] a path that is not valid UTF-8 does not prevent saving") {
	const TemporaryConfig folder;
	EditorSettings settings;
	settings.tab = "Error";
	settings.add_recent("/scenes/\xff.gltf");
	CHECK_NOTHROW(settings.save());
	CHECK(EditorSettings::load().tab == "Error");
}

TEST_CASE("[EditorSettings] a damaged file or a value out of range gives the default") {
	const TemporaryConfig folder;
	for (const char *text : { "", "{", "[]", "null", R"({ "left": "wide" })", R"({ "recent": 3 })",
				 R"({ "window_width": -5.5e300 })" }) {
		CAPTURE(text);
		write(folder, text);
		CHECK(EditorSettings::load().layout.left == EditorLayout().left);
	}
	write(folder,
			R"({ "left": 0.9, "right": -1, "window_width": 3, "reference_rays": 0, "autosave_s": 0, "tab": "Error" })");
	const EditorSettings settings = EditorSettings::load();
	CHECK(settings.layout.left == EditorLayout().left);
	CHECK(settings.layout.right == EditorLayout().right);
	CHECK(settings.window_size_px == EditorSettings().window_size_px);
	CHECK(settings.sample_count == EditorSettings().sample_count);
	CHECK(settings.autosave_s == EditorSettings().autosave_s);
	CHECK(settings.tab == "Error");
}

TEST_CASE("[EditorSettings] a file in place of the config folder causes no exception") {
	const TemporaryConfig folder;
	write(folder, "{}");
	std::filesystem::remove_all(folder.path);
	save_file_atomically(folder.path, std::string_view("a file instead"));
	CHECK_NOTHROW(EditorSettings().save());
	CHECK(EditorSettings::load().recent.empty());
}
