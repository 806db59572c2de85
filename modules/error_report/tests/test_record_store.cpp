#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#ifndef _WIN32
#include "modules/core/tests/killed_process.h"
#endif
#include "modules/core/tests/temporary_folder.h"
#include "modules/error_report/record_store.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace gnomon;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

const std::string NAME = "scene-technique-0123456789abcdef";
const Json CONTENT = { { "status", "ok" }, { "value", 0.1 }, { "list", { 1, 2.5, "x" } } };
const std::vector<uint8_t> IMAGE = { 1, 2, 3, 4, 5 };

/// Flips one bit of the byte at p_offset.
void damage_file(const fs::path &p_path, size_t p_offset) {
	std::vector<uint8_t> bytes = load_file(p_path);
	REQUIRE(p_offset < bytes.size());
	bytes[p_offset] ^= 1;
	save_file_atomically(p_path, bytes);
}

} // namespace

#ifndef _WIN32 // which has no fork; tests/platforms/test_saves.py kills programs there
TEST_CASE("[ErrorReport] a kill while a record is saved leaves it complete or absent") {
	TemporaryFolder folder;
	RecordStore store(folder.path);
	const LogSink before = set_log_sink([](LogLevel, const std::string &p_line) { FAIL(p_line); });
	size_t found_count = 0;
	const size_t kill_count = kill_at_each_save_step([&] { store.save(NAME, CONTENT, IMAGE); },
			[&] {
				const std::optional<Json> found = store.load(NAME);
				CHECK((!found || *found == CONTENT));
				found_count += found.has_value();
				store.remove(NAME);
				remove_left_over_files(folder.path);
				CHECK(fs::is_empty(folder.path));
			});
	CHECK(kill_count == 8);	 // steps: create, write, sync, rename, for the image and the JSON
	CHECK(found_count == 2); // killed after the last step, and not killed
	set_log_sink(before);
}
#endif

TEST_CASE("[ErrorReport] a loaded record equals the saved one") {
	TemporaryFolder folder;
	RecordStore store(folder.path / "new" / "cells");
	CHECK(!store.load(NAME));
	store.save(NAME, CONTENT, IMAGE);
	CHECK(store.load(NAME) == CONTENT);
	CHECK(store.load_image(NAME) == IMAGE);
	store.save(NAME, { { "other", true } });
	CHECK(store.load(NAME) == Json{ { "other", true } });
}

TEST_CASE("[ErrorReport] a damaged record is detected and treated as absent") {
	TemporaryFolder folder;
	RecordStore store(folder.path);
	size_t warning_count = 0;
	const LogSink before = set_log_sink([&](LogLevel p_level, const std::string &) {
		warning_count += p_level == LogLevel::WARNING ? 1 : 0;
	});
	const fs::path json = folder.path / (NAME + ".json");
	const fs::path png = folder.path / (NAME + ".png");
	store.save(NAME, CONTENT, IMAGE);
	const std::string whole = load_text_file(json);
	for (size_t offset = 0; offset + 1 < whole.size(); ++offset) { // all but the final newline
		damage_file(json, offset);
		CAPTURE(offset);
		CHECK(!store.load(NAME));
		save_file_atomically(json, whole);
	}
	CHECK(warning_count == whole.size() - 1);
	save_file_atomically(json, whole.substr(0, whole.size() / 2));
	CHECK(!store.load(NAME));
	save_file_atomically(json, "");
	CHECK(!store.load(NAME));
	save_file_atomically(json, whole);
	CHECK(store.load(NAME));
	damage_file(png, 2);
	CHECK(!store.load(NAME));
	fs::remove(png);
	CHECK(!store.load(NAME));
	set_log_sink(before);
}

TEST_CASE("[ErrorReport] remove_others deletes records of other plans, but no other files") {
	TemporaryFolder folder;
	RecordStore store(folder.path);
	const std::string other = "scene-technique-fedcba9876543210";
	store.save(NAME, CONTENT, IMAGE);
	store.save(other, CONTENT, IMAGE);
	// The last is no record name, since "g" is no hexadecimal digit.
	for (const char *name : { "notes.json", "holiday-2026.png", "x-0123456789abcdeg.json" }) {
		save_file_atomically(folder.path / name, "mine");
	}
	store.remove_others({ NAME });
	CHECK(store.load(NAME) == CONTENT);
	CHECK(!fs::exists(folder.path / (other + ".json")));
	CHECK(!fs::exists(folder.path / (other + ".png")));
	for (const char *name : { "notes.json", "holiday-2026.png", "x-0123456789abcdeg.json" }) {
		CHECK(fs::exists(folder.path / name));
	}
}

TEST_CASE("[ErrorReport] a folder that cannot be created is an Error") {
	TemporaryFolder folder;
	save_file_atomically(folder.path / "file", "x");
	CHECK_THROWS_WITH_AS(RecordStore(folder.path / "file" / "cells"),
			doctest::Contains("cannot be created"), Error);
}
