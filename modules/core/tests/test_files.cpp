#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/tests/temporary_folder.h"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>

using namespace gnomon;
namespace fs = std::filesystem;

TEST_CASE("[Files] an atomic save replaces the whole file and leaves no other file next to it") {
	const TemporaryFolder folder;
	save_file_atomically(folder.path / "a.txt", "first");
	save_file_atomically(folder.path / "a.txt", "second");
	CHECK(load_text_file(folder.path / "a.txt") == "second");
	CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("[Files] saving into a missing folder or over a folder is an error and creates no file") {
	CHECK_THROWS_AS(save_file_atomically("/nonexistent_gnomon/a.txt", "x"), Error);
	const TemporaryFolder folder;
	fs::create_directory(folder.path / "taken");
	CHECK_THROWS_AS(save_file_atomically(folder.path / "taken", "x"), Error);
	CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("[Files] loading a missing file, a folder or a file over the limit is an error") {
	const TemporaryFolder folder;
	CHECK_THROWS_AS(load_file(folder.path / "missing"), Error);
	CHECK_THROWS_AS(load_file(folder.path), Error);
	save_file_atomically(folder.path / "a.txt", "four");
	CHECK_THROWS_AS(load_file(folder.path / "a.txt", /*p_limit_bytes=*/3), Error);
}

TEST_CASE("[Files] an output that is a loaded file, or another output, is an error") {
	const TemporaryFolder folder;
	const fs::path input = folder.path / "in.gltf";
	save_file_atomically(input, "x");
	const fs::path other = folder.path / "other.exr";
	save_file_atomically(other, "x");
	fs::create_hard_link(input, folder.path / "hard.exr");
	const auto find_error = [](const std::vector<OutputFile> &p_outputs) -> std::string {
		try {
			check_outputs(p_outputs);
			return "";
		} catch (const Error &error) {
			return error.what();
		}
	};
	CHECK(find_error({ { "--out", input } }) == ""); // not loaded yet
	load_file(input);
	CHECK(find_error({ { "--out", input } }).find("--out") == 0);
	CHECK(find_error({ { "--out", folder.path / "." / "in.gltf" } }) != "");
	CHECK(find_error({ { "--out", folder.path / "hard.exr" } }) != "");
	CHECK(find_error({ { "--out", other }, { "--png", "" }, { "--time", "" } }) == "");
	CHECK(find_error({ { "--out", folder.path / "new" }, { "--png", folder.path / "." / "new" } })
					.find("--png and --out") == 0);
}

TEST_CASE("[Files] a path that leaves the folder through .. is not inside it") {
	CHECK(is_inside_folder("/tmp/project/scenes/a.bin", "/tmp/project"));
	CHECK(is_inside_folder("/tmp/project/scenes/../a.bin", "/tmp/project"));
	CHECK_FALSE(is_inside_folder("/tmp/project/../a.bin", "/tmp/project"));
	CHECK_FALSE(is_inside_folder("/tmp/project2/a.bin", "/tmp/project"));
	CHECK_FALSE(is_inside_folder("/etc/passwd", "/tmp/project"));
}

TEST_CASE("[Files] a damaged cache entry is detected and removed") {
	const TemporaryCache folder;
	const std::vector<uint8_t> bytes = { 1, 2, 3, 4, 5 };
	save_cache_entry("entry", bytes);
	CHECK(load_cache_entry("entry") == bytes);
	const LogSink before = set_log_sink([](LogLevel, const std::string &) {});
	SUBCASE("one byte changed") {
		std::fstream stream(folder.path / "entry", std::ios::in | std::ios::out | std::ios::binary);
		stream.seekp(-1, std::ios::end);
		stream.put(9);
	}
	SUBCASE("cut short") {
		fs::resize_file(folder.path / "entry", 11); // within the header of 24 bytes
	}
	SUBCASE("empty") {
		fs::resize_file(folder.path / "entry", 0);
	}
	CHECK(load_cache_entry("entry").empty());
	CHECK_FALSE(fs::exists(folder.path / "entry"));
	set_log_sink(before);
}

TEST_CASE("[Files] a cache entry is parsed, but rejected if a byte differs or is missing") {
	const std::vector<uint8_t> bytes = { 1, 2, 3, 250 };
	std::vector<uint8_t> entry = build_cache_entry(bytes);
	const auto payload = parse_cache_entry(entry);
	REQUIRE(payload);
	CHECK(std::vector<uint8_t>(payload->begin(), payload->end()) == bytes);
	for (size_t index = 0; index < entry.size(); ++index) {
		CAPTURE(index);
		entry[index] ^= 1;
		CHECK_FALSE(parse_cache_entry(entry));
		entry[index] ^= 1;
		CHECK_FALSE(parse_cache_entry(std::span(entry).first(index)));
	}
}

TEST_CASE("[AtomicSave] a file name of 255 bytes can be saved, one of 256 bytes is an error") {
	const TemporaryFolder folder;
	save_file_atomically(folder.path / std::string(255, 'n'), "x");
	CHECK(load_text_file(folder.path / std::string(255, 'n')) == "x");
	CHECK_THROWS_AS(save_file_atomically(folder.path / std::string(256, 'n'), "x"), Error);
	CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}
