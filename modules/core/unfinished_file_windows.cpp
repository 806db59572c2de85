#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/unfinished_file.h"

#define WIN32_LEAN_AND_MEAN
#define NOGDI // wingdi.h defines ERROR, a name of LogLevel
#include <windows.h>

#include <atomic>

// The lock is the share mode of the open file. A process that saves shares only deletion, which
// renaming needs. A process that removes leftovers opens them without sharing, which fails while
// another process has the file open. Files that a killed process had open are closed by the system.

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const int NAME_ATTEMPT_COUNT = 8; // temporary names that are tried before saving fails
// A program that reads the target, such as a virus scanner, can prevent that it is replaced. Most
// close it within milliseconds.
const int RENAME_ATTEMPT_COUNT = 50;
const DWORD RENAME_WAIT_MS = 20; // after each attempt, in all 1 s

static_assert(sizeof(intptr_t) == sizeof(HANDLE));

HANDLE to_handle(intptr_t p_file) {
	return reinterpret_cast<HANDLE>(p_file);
}

[[noreturn]] void fail_to_write(const fs::path &p_target, DWORD p_error, const char *p_next_step) {
	const std::string reason =
			std::error_code(static_cast<int>(p_error), std::system_category()).message();
	fail("Cannot write ", p_target, ": ", reason, p_next_step);
}

/// Returns the folder of the target and the beginning of a temporary file's name in it.
std::wstring make_path_prefix(const fs::path &p_target) {
	std::wstring prefix = (p_target.parent_path() / make_unfinished_prefix(p_target)).native();
	if (IS_HIGH_SURROGATE(prefix.back())) { // half a character, which some file systems refuse
		prefix.pop_back();
	}
	return prefix;
}

/// Returns a part of a file name that differs in each call and in each process.
std::wstring make_unique_name() {
	static std::atomic<uint64_t> call_count;
	LARGE_INTEGER ticks = {};
	::QueryPerformanceCounter(&ticks);
	const uint64_t values[] = { ::GetCurrentProcessId(), static_cast<uint64_t>(ticks.QuadPart),
		++call_count };
	const std::string digits =
			format_hash(compute_hash(bytes_of(std::span<const uint64_t>(values))));
	return std::wstring(digits.begin(), digits.end());
}

} // namespace

UnfinishedFile::UnfinishedFile(const fs::path &p_target) : target(p_target) {
	for (int attempt = 0; attempt < NAME_ATTEMPT_COUNT; ++attempt) {
		path = make_path_prefix(target) + L"." + make_unique_name();
		path += UNFINISHED_FILE_ENDING;
		const HANDLE handle = ::CreateFileW(path.c_str(), GENERIC_WRITE, FILE_SHARE_DELETE,
				/*security=*/nullptr, CREATE_NEW, FILE_ATTRIBUTE_NORMAL, /*template=*/nullptr);
		if (handle != INVALID_HANDLE_VALUE) {
			file = reinterpret_cast<intptr_t>(handle);
			return;
		}
		if (::GetLastError() != ERROR_FILE_EXISTS) {
			break;
		}
	}
	fail_to_write(target, ::GetLastError(), ". The folder must exist and be writable.");
}

UnfinishedFile::~UnfinishedFile() {
	::CloseHandle(to_handle(file));
	if (!is_renamed) {
		::DeleteFileW(path.c_str());
	}
}

void UnfinishedFile::write(std::span<const uint8_t> p_bytes) {
	size_t written = 0;
	while (written < p_bytes.size()) {
		DWORD count = 0;
		if (!::WriteFile(to_handle(file), p_bytes.data() + written,
					static_cast<DWORD>(p_bytes.size() - written), &count,
					/*overlapped=*/nullptr)) {
			fail_to_write(
					target, ::GetLastError(), ". Free some space or choose another location.");
		}
		written += count;
	}
}

void UnfinishedFile::sync() {
	if (!::FlushFileBuffers(to_handle(file))) {
		fail_to_write(target, ::GetLastError(), ". Free some space or choose another location.");
	}
}

void UnfinishedFile::rename_to_target() {
	for (int attempt = 1;; ++attempt) {
		if (::MoveFileExW(path.c_str(), target.c_str(),
					MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) {
			is_renamed = true;
			return;
		}
		const DWORD error = ::GetLastError();
		const bool may_end = error == ERROR_SHARING_VIOLATION || error == ERROR_ACCESS_DENIED;
		if (!may_end || attempt == RENAME_ATTEMPT_COUNT) {
			fail_to_write(target, error,
					may_end ? ". Close the programs that have it open, or choose another location."
							: ". Choose another location.");
		}
		::Sleep(RENAME_WAIT_MS);
	}
}

void remove_unless_locked(const fs::path &p_path) {
	const HANDLE handle = ::CreateFileW(p_path.c_str(), DELETE, /*share=*/0, /*security=*/nullptr,
			OPEN_EXISTING,
			FILE_FLAG_DELETE_ON_CLOSE | FILE_FLAG_OPEN_REPARSE_POINT, // not what a link leads to
			/*template=*/nullptr);
	if (handle != INVALID_HANDLE_VALUE) {
		::CloseHandle(handle);
	}
}

} // namespace gnomon
