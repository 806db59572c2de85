#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace gnomon {

/// Returns the beginning of a temporary file's name: a dot, so that it differs from all names that
/// users choose, and the target's name, shortened so that the whole stays below the limit of file
/// systems, 255 characters.
std::filesystem::path::string_type make_unfinished_prefix(const std::filesystem::path &p_target);

/// A temporary file next to the target, locked against remove_unless_locked() of all processes. A
/// failure is an Error that names the target. Implemented once for each system:
/// unfinished_file_posix.cpp, unfinished_file_windows.cpp.
class UnfinishedFile {
public:
	/// Creates the file. p_target must exist as long as this object.
	explicit UnfinishedFile(const std::filesystem::path &p_target);
	/// Removes the file, unless it was renamed, and releases the lock.
	~UnfinishedFile();
	UnfinishedFile(const UnfinishedFile &) = delete;
	UnfinishedFile &operator=(const UnfinishedFile &) = delete;

	/// Appends all bytes.
	void write(std::span<const uint8_t> p_bytes);
	/// Waits until all bytes are on disk.
	void sync();
	/// Renames the file to the target, which is replaced. Nothing may be written afterwards.
	void rename_to_target();

private:
	const std::filesystem::path &target;
	std::filesystem::path path;
	intptr_t file = -1; // descriptor or HANDLE
	bool is_renamed = false;
};

/// Removes a temporary file that no process is writing. Ignores failures.
void remove_unless_locked(const std::filesystem::path &p_path);

} // namespace gnomon
