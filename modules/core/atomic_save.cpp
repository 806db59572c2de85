#include "modules/core/files.h"
#include "modules/core/unfinished_file.h"

#include <algorithm>
#include <mutex>
#include <set>

// Implements save_file_atomically and the functions around it, which files.h declares.

namespace gnomon {

namespace fs = std::filesystem;

namespace {

const size_t CHUNK_BYTES = size_t(1) << 20; // bytes per write, 1 MiB
const size_t MAX_PREFIX_LENGTH = 128;		// characters of the target's name

std::function<void()> step_hook; // see set_save_step_hook

void end_step() {
	if (step_hook) {
		step_hook();
	}
}

/// Removes the leftovers in the target's folder, once per folder: they come from earlier processes.
void remove_left_over_files_once(const fs::path &p_target) {
	static std::mutex mutex;
	static std::set<fs::path> seen;
	const fs::path folder = p_target.has_parent_path() ? p_target.parent_path() : fs::path(".");
	const std::lock_guard lock_guard(mutex);
	if (seen.insert(fs::absolute(folder)).second) {
		remove_left_over_files(folder);
	}
}

} // namespace

fs::path::string_type make_unfinished_prefix(const fs::path &p_target) {
	return fs::path::value_type('.') + p_target.filename().native().substr(0, MAX_PREFIX_LENGTH);
}

void remove_left_over_files(const fs::path &p_folder) {
	std::error_code code;
	for (fs::directory_iterator entry(p_folder, code), end; !code && entry != end;
			entry.increment(code)) {
		const fs::path::string_type name = entry->path().filename().native();
		if (!name.empty() && name.front() == '.' &&
				entry->path().extension() == fs::path(UNFINISHED_FILE_ENDING)) {
			remove_unless_locked(entry->path());
		}
	}
}

std::function<void()> set_save_step_hook(std::function<void()> p_hook) {
	return std::exchange(step_hook, std::move(p_hook));
}

void save_file_atomically(const fs::path &p_path, std::span<const uint8_t> p_bytes) {
	remove_left_over_files_once(p_path);
	UnfinishedFile file(p_path);
	end_step();
	for (size_t begin = 0; begin < p_bytes.size(); begin += CHUNK_BYTES) {
		file.write(p_bytes.subspan(begin, std::min(CHUNK_BYTES, p_bytes.size() - begin)));
		end_step();
	}
	file.sync();
	end_step();
	file.rename_to_target();
	end_step();
}

void save_file_atomically(const fs::path &p_path, std::string_view p_text) {
	save_file_atomically(
			p_path, std::span(reinterpret_cast<const uint8_t *>(p_text.data()), p_text.size()));
}

} // namespace gnomon
