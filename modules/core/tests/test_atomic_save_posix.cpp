#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"
#include "modules/core/tests/killed_process.h"
#include "modules/core/tests/temporary_folder.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/file.h>

#include <fstream>
#include <random>

using namespace gnomon;
namespace fs = std::filesystem;

namespace {

const size_t LARGE_BYTES = (5u << 20) / 2; // 2.5 MiB, written in three chunks

std::string make_content(char p_letter, size_t p_bytes = LARGE_BYTES) {
	return std::string(p_bytes, p_letter);
}

} // namespace

TEST_CASE("[AtomicSave] a save killed at any step leaves the complete old or complete new file") {
	const TemporaryFolder folder;
	const fs::path file = folder.path / "scene.gltf";
	const std::string before = make_content('a');
	const std::string after = make_content('b', 2 * LARGE_BYTES);
	save_file_atomically(file, before);
	size_t new_count = 0;
	const size_t kill_count = kill_at_each_save_step([&] { save_file_atomically(file, after); },
			[&] {
				const std::string found = load_text_file(file);
				CHECK((found == before || found == after));
				new_count += found == after;
				CHECK(count_unfinished_files(folder.path) <= 1);
				remove_left_over_files(folder.path);
				CHECK(count_unfinished_files(folder.path) == 0);
				save_file_atomically(file, before);
			});
	CHECK(kill_count == 8); // created, five chunks, synced, renamed
	CHECK(new_count == 2);	// the run killed after the rename, and the one that was not killed
}

TEST_CASE("[AtomicSave] a process that saves into a folder removes files that killed ones left") {
	const TemporaryFolder folder;
	const fs::path file = folder.path / "a";
	const auto save = [&] { save_file_atomically(file, "text"); };
	for (int repeat = 0; repeat < 5; ++repeat) {
		const pid_t child = start_process(
				[] { set_save_step_hook([] { ::kill(::getpid(), SIGKILL); }); }, save);
		CHECK(wait_for_kill(child));
		CHECK(count_unfinished_files(folder.path) == 1);
	}
	CHECK_FALSE(wait_for_kill(start_process([] {}, save)));
	CHECK(count_unfinished_files(folder.path) == 0);
	CHECK(load_text_file(file) == "text");
}

TEST_CASE("[AtomicSave] the clean-up spares files of running processes and unrelated files") {
	const TemporaryFolder folder;
	const std::string ending(UNFINISHED_FILE_ENDING);
	const fs::path left_over = folder.path / (".a.abcdef" + ending);
	const fs::path locked = folder.path / (".b.abcdef" + ending);
	const fs::path other = folder.path / ".scene.backup";
	for (const fs::path &path : { left_over, locked, other }) {
		std::ofstream(path) << "x";
	}
	const int file = ::open(locked.c_str(), O_RDWR); // as a process that is saving does
	REQUIRE(::flock(file, LOCK_EX) == 0);
	remove_left_over_files(folder.path);
	CHECK_FALSE(fs::exists(left_over));
	CHECK(fs::exists(locked));
	CHECK(fs::exists(other));
	::close(file);
	remove_left_over_files(folder.path);
	CHECK_FALSE(fs::exists(locked));
	remove_left_over_files(folder.path / "missing"); // a missing folder is not an error
}

TEST_CASE("[AtomicSave] a save killed at a random time leaves the complete old or new file") {
	const TemporaryFolder folder;
	const fs::path file = folder.path / "a";
	const std::string first = make_content('a');
	const std::string second = make_content('b', 3 * LARGE_BYTES);
	// Without save_file_atomically: it removes leftovers only before its first save into a folder,
	// and the forked child processes would inherit that this folder was cleaned up.
	std::ofstream(file) << first;
	std::mt19937 random(20100901); // fixed seed: every run uses the same times
	std::uniform_int_distribution<int> choose_us(0, 30000);
	const int kill_count = get_kill_count(10);
	for (int index = 0; index < kill_count; ++index) {
		CAPTURE(index);
		kill_after(std::chrono::microseconds(choose_us(random)), [&] {
			for (bool is_first = true;; is_first = !is_first) {
				save_file_atomically(file, is_first ? second : first);
			}
		});
		const std::string found = load_text_file(file);
		CHECK((found == first || found == second));
		CHECK(count_unfinished_files(folder.path) <= 1); // that of the previous process is removed
	}
}

TEST_CASE("[AtomicSave] a cache entry whose write was killed is either complete or unchanged") {
	const TemporaryCache cache;
	const std::vector<uint8_t> before(3000, 1);
	const std::vector<uint8_t> after(LARGE_BYTES, 2);
	const LogSink sink = set_log_sink([](LogLevel, const std::string &p_line) { FAIL(p_line); });
	SUBCASE("without an earlier entry") {
		const size_t kill_count = kill_at_each_save_step([&] { save_cache_entry("entry", after); },
				[&] {
					const std::vector<uint8_t> found = load_cache_entry("entry");
					CHECK((found.empty() || found == after));
					fs::remove(cache.path / "entry");
				});
		CHECK(kill_count == 6); // created, three chunks, synced, renamed
	}
	SUBCASE("with an earlier entry") {
		save_cache_entry("entry", before);
		kill_at_each_save_step([&] { save_cache_entry("entry", after); },
				[&] {
					const std::vector<uint8_t> found = load_cache_entry("entry");
					CHECK((found == before || found == after));
				});
	}
	set_log_sink(sink);
}
