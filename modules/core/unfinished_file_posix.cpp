#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/unfinished_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const int LOCK_ATTEMPT_COUNT = 8; // temporary files that are created before saving fails

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

[[noreturn]] void fail_to_write(const fs::path &p_target, const char *p_next_step) {
	fail("Cannot write ", p_target, ": ", std::strerror(errno), p_next_step);
}

} // namespace

UnfinishedFile::UnfinishedFile(const fs::path &p_target) : target(p_target) {
	for (int attempt = 0; attempt < LOCK_ATTEMPT_COUNT; ++attempt) {
		std::string name = (target.parent_path() / make_unfinished_prefix(target)).native() +
				".XXXXXX" + std::string(UNFINISHED_FILE_ENDING);
		const int descriptor = ::mkostemps(
				name.data(), static_cast<int>(UNFINISHED_FILE_ENDING.size()), O_CLOEXEC);
		if (descriptor < 0) {
			fail_to_write(target, ". The folder must exist and be writable.");
		}
		// Before the lock was taken, another process may have removed the file as a leftover.
		struct stat status = {};
		lock(descriptor);
		if (::fstat(descriptor, &status) == 0 && status.st_nlink > 0) {
			path = name;
			file = descriptor;
			return;
		}
		::close(descriptor);
	}
	fail("Cannot write ", target, ": another program removes the files next to it. End that ",
			"program, or choose another location.");
}

UnfinishedFile::~UnfinishedFile() {
	if (!is_renamed) {
		::unlink(path.c_str());
	}
	::close(static_cast<int>(file)); // also releases the lock
}

void UnfinishedFile::write(std::span<const uint8_t> p_bytes) {
	size_t written = 0;
	while (written < p_bytes.size()) {
		const ssize_t count =
				::write(static_cast<int>(file), p_bytes.data() + written, p_bytes.size() - written);
		if (count < 0 && errno == EINTR) {
			continue;
		}
		if (count <= 0) {
			fail_to_write(target, ". Free some space or choose another location.");
		}
		written += static_cast<size_t>(count);
	}
}

void UnfinishedFile::sync() {
	::fchmod(static_cast<int>(file), 0644); // mkostemps creates a file that only the owner may read
	if (::fsync(static_cast<int>(file)) != 0) {
		fail_to_write(target, ". Free some space or choose another location.");
	}
}

void UnfinishedFile::rename_to_target() {
	if (::rename(path.c_str(), target.c_str()) != 0) {
		fail_to_write(target, ". Choose another location.");
	}
	is_renamed = true;
}

void remove_unless_locked(const fs::path &p_path) {
	const int file = ::open(p_path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
	if (file >= 0) {
		if (try_lock(file)) {
			::unlink(p_path.c_str());
		}
		::close(file);
	}
}

} // namespace gnomon
