#include "modules/core/error.h"
#include "modules/core/files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>

// Implements save_file_atomically and the functions around it, which files.h declares.

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const size_t CHUNK_BYTES = size_t(1) << 20; // bytes per write, 1 MiB
/// The temporary name begins with at most this many bytes of the target's name, so that it stays
/// below the limit of 255 bytes.
const size_t MAX_NAME_PREFIX_BYTES = 128;
const int LOCK_ATTEMPT_COUNT = 8; // temporary files that are created before saving fails

std::function<void()> step_hook; // see set_save_step_hook

void end_step() {
	if (step_hook) {
		step_hook();
	}
}

/// Returns false if another process is writing the file, or if the file system has no locks.
bool try_lock(int p_file) {
	return ::flock(p_file, LOCK_EX | LOCK_NB) == 0;
}

/// Locks the file. Waits while another process holds the lock because it takes the new file for a
/// leftover and removes it. On a file system without locks the file stays unlocked.
void lock(int p_file) {
	while (::flock(p_file, LOCK_EX) != 0 && errno == EINTR) {
	}
}

/// A locked temporary file next to the target. finish() renames it to the target; if that did not
/// happen, the destructor removes it.
class UnfinishedFile {
public:
	explicit UnfinishedFile(const fs::path &p_target) : target(p_target) {
		const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
		remove_left_over_files_once(folder);
		const std::string prefix = target.filename().string().substr(0, MAX_NAME_PREFIX_BYTES);
		for (int attempt = 0; attempt < LOCK_ATTEMPT_COUNT; ++attempt) {
			path = (folder / ("." + prefix + ".XXXXXX")).string() +
					std::string(UNFINISHED_FILE_ENDING);
			file = ::mkostemps(
					path.data(), static_cast<int>(UNFINISHED_FILE_ENDING.size()), O_CLOEXEC);
			if (file < 0) {
				fail("Cannot write ", target, ": ", std::strerror(errno),
						". The folder must exist and be writable.");
			}
			// Before the lock was taken, another process may have removed the file as a leftover.
			struct stat status = {};
			lock(file);
			if (::fstat(file, &status) == 0 && status.st_nlink > 0) {
				return;
			}
			::close(file);
		}
		fail("Cannot write ", target, ": another program removes the files next to it. End that ",
				"program, or choose another location.");
	}
	~UnfinishedFile() {
		if (!is_renamed) {
			::unlink(path.c_str());
		}
		::close(file); // also releases the lock
	}
	UnfinishedFile(const UnfinishedFile &) = delete;
	UnfinishedFile &operator=(const UnfinishedFile &) = delete;

	void write(std::span<const uint8_t> p_bytes) {
		size_t written = 0;
		while (written < p_bytes.size()) {
			const size_t requested = std::min(CHUNK_BYTES, p_bytes.size() - written);
			const ssize_t count = ::write(file, p_bytes.data() + written, requested);
			if (count < 0 && errno == EINTR) {
				continue;
			}
			if (count <= 0) {
				fail("Cannot write ", target, ": ", std::strerror(errno),
						". Free some space or choose another location.");
			}
			written += static_cast<size_t>(count);
			end_step();
		}
	}

	void finish() {
		::fchmod(file, 0644); // mkostemps creates a file that only the owner may read
		if (::fsync(file) != 0) {
			fail("Cannot write ", target, ": ", std::strerror(errno),
					". Free some space or choose another location.");
		}
		end_step();
		if (::rename(path.c_str(), target.c_str()) != 0) {
			fail("Cannot write ", target, ": ", std::strerror(errno), ". Choose another location.");
		}
		is_renamed = true;
		end_step();
	}

private:
	/// Removes the leftovers in a folder, once per folder: they come from earlier processes.
	static void remove_left_over_files_once(const fs::path &p_folder) {
		static std::mutex mutex;
		static std::set<fs::path> seen;
		const std::lock_guard lock_guard(mutex);
		if (seen.insert(fs::absolute(p_folder)).second) {
			remove_left_over_files(p_folder);
		}
	}

	const fs::path &target;
	std::string path;
	int file = -1;
	bool is_renamed = false;
};

} // namespace

void remove_left_over_files(const fs::path &p_folder) {
	std::error_code code;
	for (fs::directory_iterator entry(p_folder, code), end; !code && entry != end;
			entry.increment(code)) {
		const std::string name = entry->path().filename().string();
		if (!name.starts_with('.') || !name.ends_with(UNFINISHED_FILE_ENDING)) {
			continue;
		}
		const int file = ::open(entry->path().c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
		if (file >= 0) {
			if (try_lock(file)) {
				::unlink(entry->path().c_str());
			}
			::close(file);
		}
	}
}

std::function<void()> set_save_step_hook(std::function<void()> p_hook) {
	return std::exchange(step_hook, std::move(p_hook));
}

void save_file_atomically(const fs::path &p_path, std::span<const uint8_t> p_bytes) {
	UnfinishedFile file(p_path);
	end_step();
	file.write(p_bytes);
	file.finish();
}

void save_file_atomically(const fs::path &p_path, std::string_view p_text) {
	save_file_atomically(
			p_path, std::span(reinterpret_cast<const uint8_t *>(p_text.data()), p_text.size()));
}

} // namespace gnomon
