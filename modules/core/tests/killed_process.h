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

// Helpers for tests that kill a process while it saves files.

namespace gnomon {

const size_t MAX_SAVE_STEP_COUNT = 200; // limit, so that a test with a bug ends

/// Runs p_prepare and then p_work in a child process. Returns its process id. The child exits with
/// 0, or with 3 after an exception.
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

/// Waits until the process has ended. Returns true if SIGKILL ended it; otherwise returns false and
/// fails the test unless the exit code is 0.
inline bool wait_for_kill(pid_t p_child) {
	int status = 0;
	REQUIRE(::waitpid(p_child, &status, 0) == p_child);
	if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) {
		return true;
	}
	CHECK(status == 0);
	return false;
}

/// Runs p_work in a child process that is killed after its first save step (see
/// set_save_step_hook), then in another that is killed after its second, and so on until p_work
/// ends by itself. Calls p_check after each run. Returns the number of killed processes.
template <typename Work, typename Check>
size_t kill_at_each_save_step(const Work &p_work, const Check &p_check) {
	for (size_t step_count = 1; step_count <= MAX_SAVE_STEP_COUNT; ++step_count) {
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
	FAIL("the work has more than ", MAX_SAVE_STEP_COUNT, " steps");
	return 0;
}

/// Runs p_work, which must never end by itself, in a child process and kills it after p_time.
template <typename Work> void kill_after(std::chrono::microseconds p_time, const Work &p_work) {
	const pid_t child = start_process([] {}, p_work);
	std::this_thread::sleep_for(p_time);
	REQUIRE(::kill(child, SIGKILL) == 0);
	CHECK(wait_for_kill(child));
}

/// Returns how many processes a test kills at random times: the environment variable
/// GNOMON_KILL_COUNT, but at least 1; if it is not set, p_default.
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
