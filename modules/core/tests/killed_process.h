#pragma once

#include "modules/core/files.h"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

// Processes that are killed while they save, for the tests of everything that writes files.

namespace gnomon {

const size_t MOST_SAVE_STEPS = 200; // a test that never ends is no test

/// Runs the work in a child process, after p_prepare.
template <typename Prepare, typename Work>
pid_t start_process(const Prepare &p_prepare, const Work &p_work) {
	const pid_t child = ::fork();
	if (child == 0) {
		try {
			p_prepare();
			p_work();
		} catch (...) {
			::_exit(3);
		}
		::_exit(0);
	}
	REQUIRE(child > 0);
	return child;
}

/// Returns true if the process was killed, false if it had exited normally before.
inline bool wait_for_kill(pid_t p_child) {
	int status = 0;
	REQUIRE(::waitpid(p_child, &status, 0) == p_child);
	if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) {
		return true;
	}
	CHECK(status == 0);
	return false;
}

/// Kills the work after its first step of saving, then after its second, and so on until it ends by
/// itself. p_check is called after each. Returns how often it was killed.
template <typename Work, typename Check>
size_t kill_at_each_save_step(const Work &p_work, const Check &p_check) {
	for (size_t step_count = 1; step_count <= MOST_SAVE_STEPS; ++step_count) {
		CAPTURE(step_count);
		const auto prepare = [step_count] {
			set_save_step_hook([left_count = step_count]() mutable {
				if (--left_count == 0) {
					::kill(::getpid(), SIGKILL);
				}
			});
		};
		const bool was_killed = wait_for_kill(start_process(prepare, p_work));
		p_check();
		if (!was_killed) {
			return step_count - 1;
		}
	}
	FAIL("the work has more than ", MOST_SAVE_STEPS, " steps");
	return 0;
}

/// Kills the work, which never ends by itself, after that time.
template <typename Work> void kill_after(std::chrono::microseconds p_time, const Work &p_work) {
	const pid_t child = start_process([] {}, p_work);
	std::this_thread::sleep_for(p_time);
	REQUIRE(::kill(child, SIGKILL) == 0);
	CHECK(wait_for_kill(child));
}

/// Returns how often tests kill at random times: GNOMON_KILL_COUNT, else p_default.
inline int get_kill_count(int p_default) {
	const char *value = std::getenv("GNOMON_KILL_COUNT");
	return value != nullptr ? std::max(std::atoi(value), 1) : p_default;
}

inline size_t count_unfinished_files(const std::filesystem::path &p_folder) {
	size_t count = 0;
	for (const auto &entry : std::filesystem::directory_iterator(p_folder)) {
		count += entry.path().filename().string().ends_with(UNFINISHED_FILE_ENDING);
	}
	return count;
}

} // namespace gnomon
